#include <lagroid/systems/multibody/sensitivity/linearised_scene.hpp>

#include <lagroid/solvers/sensitivity/varied_parameters.hpp>

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace lagroid::multibody {

namespace {

/// The numbers, those from `first` on varied.
std::vector<VariedNumber> varied_from(const std::vector<double>& numbers, int first) {
  std::vector<VariedNumber> out(numbers.begin(), numbers.end());
  for (int k = std::max(0, first); k < std::min(int(numbers.size()), first + varied_at_once); ++k)
    out[std::size_t(k)] = VariedNumber::variable(numbers[std::size_t(k)], k - first);
  return out;
}

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

LinearisedScene::LinearisedScene(Multibody motion, std::vector<std::string> names, std::vector<double> numbers,
                                 const Write& write, std::optional<Stages> stages)
    : motion_(std::move(motion)),
      names_(std::move(names)),
      numbers_(std::move(numbers)),
      sizes_(sizes_of(motion_)),
      derivatives_(sizes_, numbers_, write),
      before_(motion_.state()),
      linear_(stages ? stages->shares.size() : 1),
      stages_(std::move(stages)),
      begin_(0, sizes_.states(), int(names_.size())) {
  if (names_.size() != numbers_.size()) throw std::invalid_argument("a name for each number");
  if (motion_.index() != 0) throw std::invalid_argument("derivatives are of a motion from its start on");
  if (before_.control) throw std::invalid_argument("controlled steps have no derivative here: take equal ones");
  if (before_.stages.size() != (stages_ ? stages_->shares.size() : 0))
    throw std::invalid_argument("composed steps are linearised stage by stage: give these");
  scenes_.emplace_back(write(varied_from(numbers_, int(numbers_.size()))), motion_);
  for (int first = 0; first < parameters(); first += varied_at_once)
    scenes_.emplace_back(write(varied_from(numbers_, first)), motion_);
  find_start();
}

const StepDerivative& LinearisedScene::stage(int k) const {
  if (begins_ && k == 0) return begin_;
  return *linear_[std::size_t(begins_ ? k - 1 : k)];
}

void LinearisedScene::find_start() {
  start_ = Eigen::MatrixXd::Zero(sizes_.states(), parameters());
  for (int first = 0; first < parameters(); first += varied_at_once) {
    VariedScene& scene = scenes_[std::size_t(1 + first / varied_at_once)];
    lagroid::detail::put_tangents(scene.start(sizes_), first, start_);
    for (const int k : torn_in(scene, sizes_, numbers_, first))
      throw WithoutDerivative(
          fmt::format("there is no derivative by {}: with another one the joints would not hold at the start, or its "
                      "velocities not agree with them",
                      names_[std::size_t(k)]));
  }
  begin_.end_by_start.leftCols(sizes_.states()).setIdentity();
  begin_.end_by_start.rightCols(parameters()) = start_;
}

StepReport LinearisedScene::advance() {
  before_ = motion_.state();
  return motion_.advance();
}

bool LinearisedScene::linearise() {
  begins_ = before_.index == 0 && parameters() > 0;
  if (stages_) return linearise_stages();
  const SceneState& after = motion_.state();
  return linearise(
      {before_, motion_.displacements(), after.guess.turns, after.guess.multipliers[0], after.at.time, after.step},
      before_.index == 0, linear_.front());
}

/// The stages of a composed step are made again, one by one.
bool LinearisedScene::linearise_stages() {
  Multibody& motion = stages_->motion;
  SceneState state = before_;
  state.stages.clear();
  bool regular = true;
  for (std::size_t k = 0; k < linear_.size(); ++k) {
    const double share = stages_->shares[k];
    state.guess = before_.stages[k];
    for (auto& multipliers : state.guess.multipliers)
      for (double& lambda : multipliers) lambda /= share;
    for (Vec& turn : state.guess.turns) turn /= share;
    motion.restore(state);
    if (!motion.advance_by(share * motion.step()).converged()) return false;
    const SceneState& after = motion.state();
    const SolvedStep solved{
        state, motion.displacements(), after.guess.turns, after.guess.multipliers[0], after.at.time, after.step};
    regular = linearise(solved, before_.index == 0 && k == 0, linear_[k]) && regular;
    state = after;
  }
  return regular;
}

bool LinearisedScene::linearise(const SolvedStep& solved, bool is_first, std::optional<SparseStep>& out) {
  derivatives_.find({motion_, scenes_}, solved, out);
  if (!out->factor()) return false;
  if (is_first && parameters() > 0 && !sizes_.left_out.empty()) require_dependence(solved, *out);
  return true;
}

void LinearisedScene::require_dependence(const SolvedStep& solved, const SparseStep& step) {
  constexpr double noticed = 1e-6;
  const int unknowns = sizes_.unknowns(), states = sizes_.states();
  Eigen::MatrixXd left(Eigen::Index(sizes_.left_out.size()), unknowns + states + parameters());
  for (int first = 0; first < unknowns + states; first += varied_at_once) {
    scenes_.front().step(solved, sizes_, first);
    lagroid::detail::put_tangents(scenes_.front().left_out(), first, left.leftCols(unknowns + states));
  }
  for (int first = 0; first < parameters(); first += varied_at_once) {
    VariedScene& scene = scenes_[std::size_t(1 + first / varied_at_once)];
    scene.step(solved, sizes_, unknowns + states);
    lagroid::detail::put_tangents(scene.left_out(), first, left.rightCols(parameters()));
  }
  Eigen::MatrixXd by(states + parameters(), parameters());
  by << start_, Eigen::MatrixXd::Identity(parameters(), parameters());
  Eigen::MatrixXd found = step.unknowns(by);
  found.topRows(3 * sizes_.linear) -= by.topRows(3 * sizes_.linear);  // w, of v + w
  const Eigen::MatrixXd by_numbers = left.rightCols(states + parameters()) * by;
  const Eigen::MatrixXd change = by_numbers + left.leftCols(unknowns) * found;
  const Eigen::MatrixXd terms = by_numbers.cwiseAbs() + left.leftCols(unknowns).cwiseAbs() * found.cwiseAbs();
  for (int k = 0; k < parameters(); ++k)
    if ((change.col(k).cwiseAbs().array() > noticed * terms.col(k).maxCoeff()).any())
      throw WithoutDerivative(fmt::format(
          "there is no derivative by {}: equations of the joints that depend on others would not, with another one",
          names_[std::size_t(k)]));
}

NodeValues LinearisedScene::observe() const {
  const SceneState& node = motion_.state();
  const int states = sizes_.states();
  NodeValues out;
  const auto put = [&](const VariedNumbers& seen, int first, int count, int column) {
    if (out.values.size() == 0) {
      out.values.resize(seen.size());
      out.derivatives.resize(seen.size(), states + parameters());
    }
    for (Eigen::Index i = 0; i < seen.size(); ++i) {
      out.values(i) = seen(i).value;
      for (int k = first; k < std::min(count, first + varied_at_once); ++k)
        out.derivatives(i, column + k) = seen(i).tangent(k - first);
    }
  };
  for (int first = 0; first < states; first += varied_at_once)
    put(scenes_.front().observe(node, sizes_, first), first, states, 0);
  for (int first = 0; first < parameters(); first += varied_at_once)
    put(scenes_[std::size_t(1 + first / varied_at_once)].observe(node, sizes_, states), first, parameters(), states);
  if (node.index == 0 && parameters() > 0)
    out.derivatives.rightCols(parameters()) += out.derivatives.leftCols(states) * start_;
  return out;
}

void LinearisedScene::serialize(NumberArchive& archive) { motion_.serialize(archive); }

namespace {

/// The holonomic rows that depend on no others.
std::vector<int> holonomic_rows(const Multibody& motion) {
  std::vector<int> rows = sizes_of(motion).rows;
  std::erase_if(rows, [&](int row) { return motion.model().role(row) != Role::holonomic; });
  return rows;
}

/// Their gradients at a node, a column for each number of v.
Eigen::MatrixXd gradients_of(const Multibody& motion, const std::vector<int>& rows) {
  const Model& model = motion.model();
  const SceneState& state = motion.state();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(motion.rows(), sizes_of(motion).n());
  const auto put = [&](const Model::Entry& e, std::size_t from) {
    all.row(e.row).segment<3>(Eigen::Index(3 * (from + std::size_t(e.factor)))) +=
        state.gradients[std::size_t(e.gradient)];
  };
  for (const Model::Entry& e : model.rows.linear_entries) put(e, 0);
  for (const Model::Entry& e : model.rows.rotation_entries) put(e, state.momentum.size());
  Eigen::MatrixXd out(Eigen::Index(rows.size()), all.cols());
  for (std::size_t k = 0; k < rows.size(); ++k) out.row(Eigen::Index(k)) = all.row(rows[k]);
  return out;
}

Eigen::VectorXd values_of_rows(const Multibody& motion, const std::vector<int>& rows) {
  const SceneState& state = motion.state();
  const std::vector<Vec> at_rest(std::max(state.momentum.size(), state.spin.size()), Vec::Zero());
  std::vector<double> values(std::size_t(motion.rows()));
  for (const Model::Batch& batch : motion.model().rows.batches)
    if (batch.role == Role::holonomic && motion.model().is_on(batch))
      batch.joints->values({state.at, state.at, at_rest, at_rest, state.step}, batch.first, batch.count,
                           values.data() + batch.row);
  Eigen::VectorXd out(Eigen::Index(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) out(Eigen::Index(k)) = values[std::size_t(rows[k])];
  return out;
}

/// W D^T.
Eigen::MatrixXd reactions_of(const Multibody& motion, const Eigen::MatrixXd& gradients) {
  const Model::Factors& factors = motion.model().factors;
  Eigen::MatrixXd out = gradients.transpose();
  Eigen::Index at = 0;
  for (const auto* inertia : {&factors.inertia, &factors.moments})
    for (const Vec& each : *inertia) {
      out.middleRows<3>(at).array().colwise() /= each.array();
      at += 3;
    }
  return out;
}

void move(Multibody& motion, const Eigen::VectorXd& by) {
  SceneState state = motion.state();
  const std::size_t linear = state.momentum.size();
  const Eigen::Index n = by.size() / 2;
  for (std::size_t f = 0; f < linear; ++f) {
    const auto at = Eigen::Index(3 * f);
    state.at.x[f] += by.segment<3>(at);
    state.momentum[f] += by.segment<3>(n + at);
  }
  for (std::size_t r = 0; r < state.spin.size(); ++r) {
    const auto at = Eigen::Index(3 * (linear + r));
    const RotationIncrement turn{Vec::Zero(), motion.model().factors.rotation};
    state.attitude[r] = product(state.attitude[r], turn.quaternion(by.segment<3>(at))).normalized();
    state.spin[r] += by.segment<3>(n + at);
  }
  motion.restore(state);
  motion.go_on_from(motion);  // what follows from places and attitudes
}

}  // namespace

void displace(Multibody& motion, const Eigen::VectorXd& by) {
  constexpr int most = 30;
  const std::vector<int> rows = holonomic_rows(motion);
  const Eigen::MatrixXd along = reactions_of(motion, gradients_of(motion, rows));
  move(motion, by);
  if (!rows.empty()) {
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0;; ++k) {
      Eigen::VectorXd back = Eigen::VectorXd::Zero(by.size());
      const Eigen::MatrixXd matrix = gradients_of(motion, rows) * along;
      back.head(along.rows()) = -along * matrix.partialPivLu().solve(values_of_rows(motion, rows));
      const double size = back.norm();
      if (!std::isfinite(size) || k == most) throw std::domain_error("the joints are not reached from such a start");
      if (size == 0 || (size < 1e-9 && size > 0.5 * before)) break;  // what is left is rounding
      move(motion, back);
      before = size;
    }
  }
  if (motion.rows() > 0) motion.make_tangent();
}

Eigen::MatrixXd LinearisedScene::allowed_directions() const {
  const int states = sizes_.states(), n = sizes_.n();
  Eigen::MatrixXd out = Eigen::MatrixXd::Identity(states, states);
  if (motion_.rows() == 0) return out;
  const std::vector<int> rows = holonomic_rows(motion_);
  const Eigen::MatrixXd gradients = gradients_of(motion_, rows), along = reactions_of(motion_, gradients);
  out.topLeftCorner(n, n) -= along * (gradients * along).partialPivLu().solve(gradients);
  Eigen::MatrixXd momenta(n, states);
  for (int first = 0; first < states; first += varied_at_once)
    lagroid::detail::put_tangents(scenes_.front().tangent_momenta(motion_.state(), sizes_, first), first, momenta);
  out.bottomRows(n) = momenta * out;
  return out;
}

}  // namespace lagroid::multibody
