#include <lagroid/systems/multibody/sensitivity/scene_variations.hpp>

#include <lagroid/solvers/sensitivity/varied_parameters.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lagroid::multibody {

std::vector<VariedNumber> varied_from(const std::vector<double>& numbers, int first) {
  std::vector<VariedNumber> out(numbers.begin(), numbers.end());
  for (int k = std::max(0, first); k < std::min(int(numbers.size()), first + varied_at_once); ++k)
    out[std::size_t(k)] = VariedNumber::variable(numbers[std::size_t(k)], k - first);
  return out;
}

namespace {

/// Of the numbers by which a scene is varied, those by which its joints would not hold at the start.
std::vector<int> torn_in(VariedScene& scene, const SceneSizes& sizes, const std::vector<double>& numbers, int first) {
  constexpr double noticed = 1e-9;
  const std::vector<VariedScene::Held> held = scene.held(sizes);
  std::vector<int> out;
  for (int k = first; k < std::min(int(numbers.size()), first + varied_at_once); ++k) {
    const double number = std::abs(numbers[std::size_t(k)]);
    const auto tears = [&](const VariedScene::Held& each) {
      return std::abs(each.left.tangent(k - first)) * (number > 0 ? number : 1) > noticed * each.size;
    };
    if (std::any_of(held.begin(), held.end(), tears)) out.push_back(k);
  }
  return out;
}

}  // namespace

SceneVariations::SceneVariations(const Multibody& motion, const std::vector<double>& numbers, const WriteScene& write)
    : sizes_(sizes_of(motion)),
      parameters_(int(numbers.size())),
      of_steps_(sizes_, numbers, write),
      of_parts_(sizes_, numbers, write, motion.step()) {
  scenes_.emplace_back(write(varied_from(numbers, parameters_)), motion);
  for (int first = 0; first < parameters_; first += varied_at_once)
    scenes_.emplace_back(write(varied_from(numbers, first)), motion);
}

Eigen::MatrixXd SceneVariations::start(const std::vector<std::string>& names, const std::vector<double>& numbers) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(sizes_.states(), parameters_);
  for (int first = 0; first < parameters_; first += varied_at_once) {
    VariedScene& scene = by_numbers(first);
    lagroid::detail::put_tangents(scene.start(sizes_), first, out);
    for (const int k : torn_in(scene, sizes_, numbers, first))
      throw WithoutDerivative(
          fmt::format("there is no derivative by {}: with another one the joints would not hold at the start, or its "
                      "velocities not agree with them",
                      names[std::size_t(k)]));
  }
  return out;
}

bool SceneVariations::linearise(const Multibody& motion, const SolvedStep& solved, bool by_times,
                                std::optional<SparseStep>& out) {
  (by_times ? of_parts_ : of_steps_).find({motion, scenes_}, solved, out);
  return out->factor();
}

void SceneVariations::require_dependence(const SolvedStep& solved, const SparseStep& step, const Eigen::MatrixXd& start,
                                         const std::vector<std::string>& names) {
  constexpr double noticed = 1e-6;
  const int unknowns = sizes_.unknowns(), states = sizes_.states();
  Eigen::MatrixXd left(Eigen::Index(sizes_.left_out.size()), unknowns + states + parameters_);
  for (int first = 0; first < unknowns + states; first += varied_at_once) {
    scenes_.front().step(solved, sizes_, first);
    lagroid::detail::put_tangents(scenes_.front().left_out(), first, left.leftCols(unknowns + states));
  }
  for (int first = 0; first < parameters_; first += varied_at_once) {
    VariedScene& scene = by_numbers(first);
    scene.step(solved, sizes_, unknowns + states);
    lagroid::detail::put_tangents(scene.left_out(), first, left.rightCols(parameters_));
  }
  // The times of a part stay.
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(step.pattern()->columns() - unknowns, parameters_);
  by.topRows(states) = start;
  by.middleRows(states, parameters_).setIdentity();
  Eigen::MatrixXd found = step.unknowns(by);
  found.topRows(3 * sizes_.linear) -= by.topRows(3 * sizes_.linear);  // w, of v + w
  const Eigen::MatrixXd by_numbers = left.rightCols(states + parameters_) * by.topRows(states + parameters_);
  const Eigen::MatrixXd change = by_numbers + left.leftCols(unknowns) * found;
  const Eigen::MatrixXd terms = by_numbers.cwiseAbs() + left.leftCols(unknowns).cwiseAbs() * found.cwiseAbs();
  for (int k = 0; k < parameters_; ++k)
    if ((change.col(k).cwiseAbs().array() > noticed * terms.col(k).maxCoeff()).any())
      throw WithoutDerivative(fmt::format(
          "there is no derivative by {}: equations of the joints that depend on others would not, with another one",
          names[std::size_t(k)]));
}

template <class Of> NodeValues SceneVariations::along_all(bool by_time, const Of& of) {
  const int states = sizes_.states(), directions = by_time ? sizes_.directions() : states;
  NodeValues out;
  const auto put = [&](const VariedNumbers& values, int first, int count, const auto& column_of) {
    if (out.values.size() == 0) {
      out.values.resize(values.size());
      out.derivatives.resize(values.size(), directions + parameters_);
    }
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      out.values(i) = values(i).value;
      for (int k = first; k < std::min(count, first + varied_at_once); ++k)
        out.derivatives(i, column_of(k)) = values(i).tangent(k - first);
    }
  };
  for (int first = 0; first < directions; first += varied_at_once)
    put(of(scenes_.front(), first), first, directions, [&](int k) { return k < states ? k : k + parameters_; });
  for (int first = 0; first < parameters_; first += varied_at_once)
    put(of(by_numbers(first), sizes_.directions()), first, parameters_, [&](int k) { return states + k; });
  return out;
}

NodeValues SceneVariations::observe(const SceneState& node, bool by_time) {
  return along_all(by_time, [&](VariedScene& scene, int first) { return scene.observe(node, sizes_, first); });
}

Eigen::VectorXd SceneVariations::seen(const SceneState& node) {
  const VariedNumbers all = scenes_.front().observe(node, sizes_, sizes_.directions());
  Eigen::VectorXd out(all.size());
  for (Eigen::Index i = 0; i < all.size(); ++i) out(i) = all(i).value;
  return out;
}

NodeValues SceneVariations::time_scale_rate(const SceneState& node) {
  return along_all(true, [&](VariedScene& scene, int first) {
    return VariedNumbers(VariedNumbers::Constant(1, scene.time_scale_rate(node, sizes_, first)));
  });
}

NodeValues SceneVariations::held_places(const SceneState& node) {
  return along_all(true, [&](VariedScene& scene, int first) { return scene.held_places(node, sizes_, first); });
}

NodeValues SceneVariations::tangent_momenta(const SceneState& node) {
  return along_all(true, [&](VariedScene& scene, int first) { return scene.tangent_momenta(node, sizes_, first); });
}

}  // namespace lagroid::multibody
