#include <lagroid/systems/multibody/control/controlled_scene.hpp>

#include <lagroid/systems/multibody/control/arrow_momenta.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace lagroid::multibody {

ControlledScene::ControlledScene(SceneControl task) : task_(std::move(task)), motion_(motion_of(task_)) {
  require_task();
  find_controls();
  find_rows();
  plain_ = std::make_unique<NodeForces<double>>(task_.scene(), controls_, rows_);
  varied_ = std::make_unique<NodeForces<SecondNumber>>(task_.second(), controls_, rows_);
  if (varied_->linear() != plain_->linear() || varied_->rotations() != plain_->rotations())
    throw std::invalid_argument("the scene over numbers with derivatives has other bodies");
  std::vector<char> on = motion_.switches().on;
  for (const int control : controls_) on[std::size_t(control)] = 0;
  if (on != motion_.switches().on) motion_.switch_to(on);

  find_damping();
  const SceneState& state = motion_.state();
  start_.places.assign(state.at.x.begin(), state.at.x.begin() + linear());
  start_.attitudes.assign(state.at.attitude.begin(), state.at.attitude.begin() + (factors() - linear()));
  start_.momenta.resize(n());
  std::vector<double> weights;
  for (int f = 0; f < factors(); ++f) {
    const bool turns = f >= linear();
    start_.momenta.segment<3>(3 * f) = turns ? state.spin[std::size_t(f - linear())] : state.momentum[std::size_t(f)];
    for (int i = 0; i < 3; ++i) weights.push_back(1 / inertia(f)(i));
  }
  momenta_.resize(std::size_t(n()));
  varied_momenta_.assign(std::size_t(n()), SecondNumber(0));
  conditions_ = EndConditions(task_.end, joints(), std::move(weights), drag_, motion_.model().factors.planar);
  gradients_.resize(joints(), n());
  along_.resize(n(), joints());
  matrix_.resize(joints(), joints());
  aim_.resize(joints());
  left_.resize(joints());
  by_.setZero(2 * n());
  limits_ = NodeLimits(task_, *plain_);
  require_limits();
  conditions_.hold(held_by_motion());
  find_end();
}

Multibody ControlledScene::motion_of(const SceneControl& task) {
  if (!(task.duration > 0)) throw std::invalid_argument(fmt::format("duration: {} is not positive", task.duration));
  if (task.stages < 2) throw std::invalid_argument("stages: a trajectory has at least two");
  return {task.scene(), task.duration / double(task.stages)};
}

void ControlledScene::require_task() const {
  if (task_.actuators.empty()) throw std::invalid_argument("nothing is controlled: name an effect as an actuator");
  bool costs = task_.duration_weight > 0;
  for (const Actuator& each : task_.actuators) {
    if (!(each.lower < each.upper))
      throw std::invalid_argument(fmt::format("actuator \"{}\": its lower bound {} is not below its upper bound {}",
                                              each.effect, each.lower, each.upper));
    if (!(each.weight >= 0))
      throw std::invalid_argument(fmt::format("actuator \"{}\": its weight {} is negative", each.effect, each.weight));
    costs = costs || each.weight > 0;
  }
  NodeLimits::require(task_);
  if (!costs) throw std::invalid_argument("nothing costs: give an actuator or the duration a weight");
  if (task_.duration_is_free && !(task_.duration_weight > 0))
    throw std::invalid_argument("a duration that is free without a cost may grow for ever: give it a weight");
  if (motion_.dependent_rows() > 0)
    throw std::invalid_argument(fmt::format(
        "{} equations of the joints depend on others, as in loops in space: leave joints out that follow from the "
        "others",
        motion_.dependent_rows()));
  const Model& model = motion_.model();
  if (!model.points.moving.empty())
    throw std::invalid_argument("points of the ground that move are not controlled here: let them rest");
  for (const Model::Batch& batch : model.rows.batches)
    if (batch.role != Role::holonomic && batch.role != Role::damping)
      throw std::invalid_argument(
          "joints on velocities (rolling, blades, driven hinges) are not controlled here: leave them out");
  if (!(motion_.constraint_residual() < 1e-8)) throw std::invalid_argument("the joints do not hold at the start");
  if (motion_.velocity_defect() > 1e-9)
    throw std::invalid_argument("the joints do not allow the velocities at the start");
}

void ControlledScene::require_limits() {
  const std::vector<double> speeds = velocities(start_);
  for (int i = 0; i < limits_.size(); ++i) {
    const int of_speed = i - limits_.on_places();
    const double value = of_speed < 0 ? limits_.value(i, *plain_) : limits_.value_of_speed(of_speed, speeds);
    if (!(value <= limit_rounding))
      throw std::invalid_argument(
          fmt::format("{} does not hold at the start: begin where it does, or leave it out", limits_.name(i)));
  }
}

void ControlledScene::find_controls() {
  const std::vector<std::string>& names = motion_.switches().names;
  for (const Actuator& each : task_.actuators) {
    const auto found = std::find(names.begin() + 1, names.end(), each.effect);
    if (found == names.end())
      throw std::invalid_argument(fmt::format(
          "there is no effect \"{}\" to be controlled; {}", each.effect,
          names.size() == 1 ? std::string("none has a name")
                            : fmt::format("names are {}", fmt::join(names.begin() + 1, names.end(), ", "))));
    const int number = int(found - names.begin());
    if (std::find(controls_.begin(), controls_.end(), number) != controls_.end())
      throw std::invalid_argument(fmt::format("effect \"{}\" is controlled twice", each.effect));
    for (const Model::Batch& batch : motion_.model().rows.batches)
      if (batch.switched_by == number)
        throw std::invalid_argument(fmt::format("\"{}\" is a {}: controls are strengths of forces", each.effect,
                                                batch.role == Role::damping ? "damper" : "joint"));
    controls_.push_back(number);
  }
}

void ControlledScene::find_damping() {
  const Model& model = motion_.model();
  drag_.assign(std::size_t(factors()), Mat::Zero());
  for (const Model::Dragged& each : model.factors.dragged) drag_[std::size_t(each.factor)] = each.drag;
  for (const int r : model.factors.damped_turns)
    drag_[std::size_t(linear() + r)] = model.factors.turn_damping[std::size_t(r)].asDiagonal();
  const bool damped = std::any_of(model.rows.batches.begin(), model.rows.batches.end(), [&](const Model::Batch& batch) {
    return batch.role == Role::damping && model.is_on(batch);
  });
  if (!damped) return;
  plain_dampers_ = std::make_unique<DamperForces<double>>(task_.scene(), model.switches.on);
  varied_dampers_ = std::make_unique<DamperForces<SecondNumber>>(task_.second(), model.switches.on);
}

// A pin's third row moves nothing, and is left out of the motion's.
void ControlledScene::find_rows() {
  const Model& model = motion_.model();
  for (const Model::Batch& batch : model.rows.batches)
    for (int row = batch.row; row < batch.row + batch.count * batch.joints->rows(); ++row)
      if (batch.role == Role::holonomic && model.is_on(batch) && !model.rows.left_out[std::size_t(row)])
        rows_.push_back(row);
  std::sort(rows_.begin(), rows_.end());
}

void ControlledScene::displace(const ControlledNode& node, const double* by, double fraction,
                               ControlledNode& out) const {
  for (int f = 0; f < factors(); ++f) {
    const Vec v = fraction * Eigen::Map<const Vec>(by + 3 * f);
    if (f < linear()) {
      out.places[std::size_t(f)] = node.places[std::size_t(f)] + v;
    } else {
      const auto r = std::size_t(f - linear());
      out.attitudes[r] = SO3::project(Mat(node.attitudes[r] * turn_of(rotation(), v)));
    }
  }
  out.momenta = node.momenta + fraction * Eigen::Map<const Eigen::VectorXd>(by + n(), n());
}

void ControlledScene::displace_along_joints(const ControlledNode& node, const double* by, double fraction,
                                            ControlledNode& out) {
  displace(node, by, fraction, out);
  if (joints() == 0) return;
  constexpr int most = 30;
  const auto look = [&](const ControlledNode& at) {
    const NodeForces<double>& here = forces(at);
    for (int row = 0; row < joints(); ++row) {
      left_(row) = here.joint(row);
      for (int i = 0; i < n(); ++i) gradients_(row, i) = here.gradient(row, i);
    }
  };
  look(node);
  aim_ = left_;
  for (int i = 0; i < n(); ++i) {
    aim_ += (fraction * by[i]) * gradients_.col(i);
    along_.row(i) = gradients_.col(i).transpose() / inertia(i / 3)(i % 3);
  }
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < most; ++k) {
    look(out);
    left_ -= aim_;
    matrix_.noalias() = gradients_ * along_;
    factor_.compute(matrix_);
    left_ = factor_.solve(left_).eval();
    by_.head(n()).noalias() = -along_ * left_;
    const double size = by_.norm();
    if (size == 0 || (size < 1e-9 && size > 0.5 * before)) return;  // what is left is rounding
    if (!std::isfinite(size) || size > 2 * before) break;
    displace(out, by_.data(), 1, out);
    before = size;
  }
  displace(node, by, fraction, out);
}

Eigen::VectorXd ControlledScene::difference(const ControlledNode& from, const ControlledNode& to) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(2 * n());
  for (int f = 0; f < linear(); ++f) out.segment<3>(3 * f) = to.places[std::size_t(f)] - from.places[std::size_t(f)];
  for (int f = linear(); f < factors(); ++f) {
    const auto r = std::size_t(f - linear());
    const Mat turn = from.attitudes[r].transpose() * to.attitudes[r];
    out.segment<3>(3 * f) = rotation() == Retraction::exponential ? SO3::log(turn) : SO3::cayley_inverse(turn);
  }
  return out;
}

bool ControlledScene::project(ControlledNode& node) {
  constexpr int most = 50;
  ControlledNode moved = node;
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < most && joints() > 0; ++k) {
    const NodeForces<double>& at = forces(moved);
    for (int row = 0; row < joints(); ++row) {
      left_(row) = at.joint(row);
      for (int i = 0; i < n(); ++i) {
        gradients_(row, i) = at.gradient(row, i);
        along_(i, row) = gradients_(row, i) / inertia(i / 3)(i % 3);
      }
    }
    by_.head(n()) = -along_ * (gradients_ * along_).eval().partialPivLu().solve(left_);
    const double size = by_.norm();
    if (!std::isfinite(size)) return false;
    if (size == 0 || (size < 1e-9 && size > 0.5 * before)) break;  // what is left is rounding
    if (k + 1 == most) return false;
    displace(moved, by_.data(), std::min(1.0, 1 / size), moved);
    before = size;
  }
  node.places = moved.places;
  node.attitudes = moved.attitudes;
  return true;
}

std::optional<std::vector<ControlledNode>> ControlledScene::drift(long stages) const {
  std::vector<ControlledNode> out(std::size_t(stages) + 1, start_);
  Multibody motion = motion_of(task_);
  motion.switch_to(motion_.switches().on);
  for (long k = 1; k <= stages; ++k) {
    if (!motion.advance().converged()) return std::nullopt;
    const SceneState& state = motion.state();
    ControlledNode& node = out[std::size_t(k)];
    for (int f = 0; f < factors(); ++f) {
      const auto r = std::size_t(std::max(f - linear(), 0));
      if (f < linear()) node.places[std::size_t(f)] = state.at.x[std::size_t(f)];
      if (f >= linear()) node.attitudes[r] = state.at.attitude[r];
      node.momenta.segment<3>(3 * f) = f < linear() ? state.momentum[std::size_t(f)] : state.spin[r];
    }
  }
  return out;
}

}  // namespace lagroid::multibody
