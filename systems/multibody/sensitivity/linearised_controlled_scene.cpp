#include <lagroid/systems/multibody/sensitivity/linearised_controlled_scene.hpp>

#include <stdexcept>
#include <utility>

namespace lagroid::multibody {

namespace {

/// A step by (v, mu, t, rho, theta), of one by (v, mu, theta, t, h).
class ControlledStep final : public StepDerivative {
 public:
  /// `rate`: of the time scale at the target, by (v, mu, theta, t).
  ControlledStep(SparseStep step, double size, double first_step, Eigen::RowVectorXd rate)
      : step_(std::move(step)),
        of_scene_(step_.pattern()->states),
        size_by_density_(-size * size / first_step),
        rate_(-first_step * std::move(rate)) {}

  Eigen::MatrixXd forward(const Eigen::MatrixXd& directions) const override {
    const Eigen::Index time = of_scene_, density = time + 1, numbers = directions.rows() - of_scene_ - 2;
    Eigen::MatrixXd own(directions.rows(), directions.cols());
    own.topRows(of_scene_) = directions.topRows(of_scene_);
    own.middleRows(of_scene_, numbers) = directions.bottomRows(numbers);
    own.row(of_scene_ + numbers) = directions.row(time);
    own.bottomRows(1) = size_by_density_ * directions.row(density);
    own = step_.forward(own);
    Eigen::MatrixXd out = directions;
    out.topRows(of_scene_) = own.topRows(of_scene_);
    out.row(time) = own.row(of_scene_ + numbers) += own.bottomRows(1);
    out.row(density) += rate_ * own.topRows(rate_.size());
    return out;
  }
  Eigen::MatrixXd backward(const Eigen::MatrixXd& gradients) const override {
    const Eigen::Index time = of_scene_, density = time + 1, numbers = gradients.rows() - of_scene_ - 2;
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(gradients.rows(), gradients.cols());
    own.topRows(rate_.size()) = rate_.transpose() * gradients.row(density);
    own.topRows(of_scene_) += gradients.topRows(of_scene_);
    own.row(of_scene_ + numbers) += gradients.row(time);
    own.bottomRows(1) = own.row(of_scene_ + numbers);
    own = step_.backward(own);
    Eigen::MatrixXd out = gradients;
    out.topRows(of_scene_) = own.topRows(of_scene_);
    out.row(time) = own.row(of_scene_ + numbers);
    out.row(density) += size_by_density_ * own.bottomRows(1);
    out.bottomRows(numbers) += own.middleRows(of_scene_, numbers);
    return out;
  }

 private:
  SparseStep step_;
  Eigen::Index of_scene_;
  double size_by_density_;
  Eigen::RowVectorXd rate_;  ///< of the density
};

/// The same, if it can be linearised.
Multibody at_start(Multibody motion, bool is_named) {
  if (!is_named) throw std::invalid_argument("a name for each number");
  if (motion.index() != 0) throw std::invalid_argument("derivatives are of a motion from its start on");
  if (!motion.state().control)
    throw std::invalid_argument("steps are equal: their derivatives are those of LinearisedScene");
  return motion;
}

}  // namespace

LinearisedControlledScene::LinearisedControlledScene(Multibody motion, std::vector<std::string> names,
                                                     std::vector<double> numbers, const WriteScene& write)
    : motion_(at_start(std::move(motion), names.size() == numbers.size())),
      varied_(motion_, numbers, write),
      first_step_(motion_.step()),
      before_(motion_.state()),
      begin_(0, states(), int(names.size())) {
  const int of_scene = varied_.sizes().states();
  Eigen::MatrixXd start =
      Eigen::MatrixXd::Zero(of_scene + 1 + parameters(), states() + parameters());  // v, mu, theta, t
  start.topLeftCorner(of_scene, of_scene).setIdentity();
  start.topRightCorner(of_scene, parameters()) = varied_.start(names, numbers);
  start.block(of_scene, states(), parameters(), parameters()).setIdentity();
  start(of_scene + parameters(), of_scene) = 1;
  begin_.end_by_start.topRows(of_scene) = start.topRows(of_scene);
  begin_.end_by_start.row(of_scene) = start.bottomRows(1);
  begin_.end_by_start.row(of_scene + 1) =
      -0.5 * first_step_ * (varied_.time_scale_rate(before_).derivatives.row(0) * start);
}

StepReport LinearisedControlledScene::advance() {
  before_ = motion_.state();
  return motion_.advance();
}

bool LinearisedControlledScene::linearise() {
  begins_ = before_.index == 0;
  const SceneState& after = motion_.state();
  std::optional<SparseStep> step;
  if (!varied_.linearise(motion_, solved_step(before_, after, motion_.displacements()), /*by_times=*/true, step))
    return false;
  step_ = std::make_unique<ControlledStep>(std::move(*step), after.step, first_step_,
                                           varied_.time_scale_rate(after).derivatives.row(0));
  return true;
}

const StepDerivative& LinearisedControlledScene::stage(int k) const {
  if (begins_ && k == 0) return begin_;
  return *step_;
}

Eigen::MatrixXd LinearisedControlledScene::with_density(const Eigen::MatrixXd& by) const {
  const int of_scene = varied_.sizes().states();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(by.rows(), states() + parameters());
  out.leftCols(of_scene) = by.leftCols(of_scene);
  out.col(of_scene) = by.col(of_scene + parameters());
  out.rightCols(parameters()) = by.middleCols(of_scene, parameters());
  return out;
}

NodeValues LinearisedControlledScene::observe() const {
  NodeValues out = varied_.observe(motion_.state(), /*by_time=*/true);
  if (out.values.size() == 0) return out;
  out.derivatives = with_density(out.derivatives);
  if (motion_.index() == 0)
    out.derivatives.rightCols(parameters()) +=
        out.derivatives.leftCols(states()) * begin_.end_by_start.rightCols(parameters());
  return out;
}

std::optional<NodeValues> LinearisedControlledScene::observe_later(double time) {
  const SceneState here = motion_.state();
  std::optional<SparseStep> step;
  NodeValues there;
  const bool is_reached =
      motion_.advance_by(time - here.at.time).converged() &&
      varied_.linearise(motion_, solved_step(here, motion_.state(), motion_.displacements()), /*by_times=*/true, step);
  if (is_reached) there = varied_.observe(motion_.state(), /*by_time=*/true);
  motion_.restore(here);
  if (!is_reached) return std::nullopt;
  // It ends at this time, whenever it began: a later start makes it shorter.
  const int of_scene = varied_.sizes().states(), count = of_scene + parameters();
  Eigen::MatrixXd from = Eigen::MatrixXd::Zero(count + 2, count + 1);
  from.topLeftCorner(count + 1, count + 1).setIdentity();
  from(count + 1, count) = -1;
  const Eigen::MatrixXd by = there.derivatives.leftCols(count) * step->forward(from).topRows(count);
  there.derivatives = with_density(by);
  if (here.index == 0)
    there.derivatives.rightCols(parameters()) +=
        there.derivatives.leftCols(states()) * begin_.end_by_start.rightCols(parameters());
  return there;
}

}  // namespace lagroid::multibody
