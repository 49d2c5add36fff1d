// Steps of scenes that are made in part, and what changes the motion in between.
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>
#include <lagroid/systems/multibody/sensitivity/linearised_scene.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::multibody {

namespace {

/// A stage of a part: by a share of its duration, after the share that those before it took. The last two of the
/// directions are the time and the duration.
class StageOfPart final : public StepDerivative {
 public:
  StageOfPart(SparseStep step, double share, double gone) : step_(std::move(step)), share_(share), gone_(gone) {}

  Eigen::MatrixXd forward(const Eigen::MatrixXd& directions) const override {
    const Eigen::Index s = directions.rows() - 1, t = s - 1;
    Eigen::MatrixXd own = directions;
    own.row(t) += gone_ * directions.row(s);
    own.row(s) *= share_;
    own = step_.forward(own);
    own.bottomRows(2) = directions.bottomRows(2);
    return own;
  }
  Eigen::MatrixXd backward(const Eigen::MatrixXd& gradients) const override {
    const Eigen::Index s = gradients.rows() - 1, t = s - 1;
    Eigen::MatrixXd own = gradients;
    own.bottomRows(2).setZero();
    own = step_.backward(own);
    own.row(s) = share_ * own.row(s) + gone_ * own.row(t) + gradients.row(s);
    own.row(t) += gradients.row(t);
    return own;
  }

 private:
  SparseStep step_;
  double share_, gone_;
};

}  // namespace

StepReport LinearisedScene::go(double duration) {
  motion_.restore(kept_);
  if (duration > 0) return motion_.advance_by(duration);
  return {SolveStatus::converged};
}

Derivatives LinearisedScene::part() {
  Derivatives out;
  if (kept_.index == 0 && parameters() > 0) {
    // What numbers do to the start comes before the first step.
    Eigen::MatrixXd start = Eigen::MatrixXd::Identity(states(), states() + parameters() + 2);
    start.middleCols(states(), parameters()) = start_;
    out.push_back(std::make_shared<ReplacedRows>(0, std::move(start)));
  }
  if (!stages_) {
    std::optional<SparseStep> step;
    const SolvedStep solved = solved_step(kept_, motion_.state(), motion_.displacements());
    if (!linearise(solved, /*by_times=*/true, step)) return {};
    out.push_back(std::make_shared<SparseStep>(std::move(*step)));
    return out;
  }
  std::vector<std::optional<SparseStep>> steps(stages_->shares.size());
  if (!linearise_stages(kept_, motion_.time() - kept_.at.time, /*by_times=*/true, steps)) return {};
  double gone = 0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double share = stages_->shares[k];
    out.push_back(std::make_shared<StageOfPart>(std::move(*steps[k]), share, gone));
    gone += share;
  }
  return out;
}

void LinearisedScene::kick(const Eigen::VectorXd& by) {
  SceneState state = motion_.state();
  const auto add = [&](std::vector<Vec>& momenta, Eigen::Index from) {
    for (std::size_t i = 0; i < momenta.size(); ++i) momenta[i] += by.segment<3>(from + Eigen::Index(3 * i));
  };
  add(state.momentum, 0);
  add(state.spin, Eigen::Index(3 * state.momentum.size()));
  motion_.restore(state);
}

LinearisedScene::Switched LinearisedScene::switch_to(const Switching& what, bool linearised) {
  constexpr double joints_hold = 1e-8;
  const Switches& switches = motion_.switches();
  std::vector<char> on = switches.on;
  for (const auto& [name, acts] : what) {
    const auto found = std::find(switches.names.begin() + 1, switches.names.end(), name);
    if (found == switches.names.end()) throw std::invalid_argument("nothing is switched by the name \"" + name + "\"");
    const auto number = int(found - switches.names.begin());
    if (acts && !(motion_.violation(number) < joints_hold))
      throw std::domain_error("\"" + name + "\" is switched on where it does not hold");
    on[std::size_t(number)] = acts;
  }
  Switched out;
  if (linearised) {
    if (motion_.model().rows.vakonomic)
      throw WithoutDerivative("there are no derivatives through switches where there are vakonomic joints");
    // Whatever the duration.
    const NodeValues momenta = variations().tangent_momenta(motion_.state());
    Eigen::MatrixXd by = Eigen::MatrixXd::Zero(states() / 2, momenta.derivatives.cols() + 1);
    by.leftCols(momenta.derivatives.cols()) = momenta.derivatives;
    out.momentum.push_back(std::make_shared<ReplacedRows>(states() / 2, std::move(by)));
    out.held = variations().held_places(motion_.state()).derivatives;
  }
  motion_.switch_to(on);
  if (!linearised) return out;
  const std::vector<int>& left_out = variations().sizes().left_out;
  if (!left_out.empty() && left_out != left_out_)
    throw WithoutDerivative(
        "there is no derivative through a switch after which equations of the joints depend on others that did not "
        "before");
  out.holds = variations().held_places(motion_.state()).derivatives;
  return out;
}

}  // namespace lagroid::multibody
