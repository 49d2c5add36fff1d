#include "predicted_runs.hpp"

#include <lagroid/run/events/derivatives/motion_through_events.hpp>

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

namespace lagroid::app {

/// A run from one measurement to the next, with the derivatives of its state.
class PredictedRuns::Course {
 public:
  Course(std::unique_ptr<LinearisedMotion> motion, Eigen::MatrixXd directions)
      : motion_(std::move(motion)), directions_(std::move(directions)) {}

  const LinearisedMotion& motion() const { return *motion_; }
  const Eigen::MatrixXd& directions() const { return directions_; }

  /// What is observed where this was measured; none where the run fails before.
  std::optional<NodeValues> at(const MeasuredNumber& measured) {
    if (measured.node < 0) return between_nodes(measured.time);
    for (; node_ < measured.node; ++node_)
      if (!advance()) return std::nullopt;
    return here();
  }

 private:
  bool advance() {
    if (!motion_->advance().converged()) return false;
    if (directions_.cols() == 0) return true;
    if (!motion_->linearise()) return false;
    for (int k = 0; k < motion_->stages(); ++k) directions_ = motion_->stage(k).forward(directions_);
    return true;
  }
  /// From the last node before it.
  std::optional<NodeValues> between_nodes(double time) {
    if (node_ == 0) look_ahead();
    while (next_node_ + shortest * (next_node_ - motion_->time()) <= time) {
      if (!advance()) return std::nullopt;
      look_ahead();
    }
    return time == motion_->time() ? here() : motion_->observe_later(time);
  }
  /// At a node, with derivatives where they are asked for.
  NodeValues here() const {
    if (directions_.cols() > 0) return motion_->observe();
    return {motion_->seen(), {}};
  }
  /// When the next node is; the step after that is made again.
  void look_ahead() {
    ++node_;
    const std::vector<double> here = motion_->save();
    next_node_ = motion_->advance().converged() ? motion_->time() : infinite;
    motion_->restore(here);
  }

  /// Of a step: what follows a node sooner is reached from the node before, for the momenta of a part of a step are
  /// differences of places over its duration.
  static constexpr double shortest = 1e-3;
  std::unique_ptr<LinearisedMotion> motion_;
  Eigen::MatrixXd directions_;
  long node_ = 0;
  double next_node_ = 0;
};

PredictedRuns::PredictedRuns(const GradientSubject& subject, const GradientColumns& columns,
                             std::vector<MeasuredRun> runs)
    : subject_(subject), columns_(columns), runs_(std::move(runs)), x_(unknowns(), 0.0) {
  std::size_t count = 0;
  for (const MeasuredRun& run : runs_) count += run.size();
  predicted_ = Eigen::VectorXd::Zero(Eigen::Index(count));
  derivatives_ = Eigen::MatrixXd::Zero(Eigen::Index(count), Eigen::Index(unknowns()));
}

void PredictedRuns::PrepareForEvaluation(bool with_derivatives, bool) {
  failure_.clear();
  std::size_t first = 0;
  for (std::size_t r = 0; r < runs_.size() && failure_.empty(); ++r) {
    predict(r, first, with_derivatives);
    first += runs_[r].size();
  }
}

std::vector<Nudge> PredictedRuns::nudges_of(std::size_t run) const {
  std::vector<Nudge> out;
  const std::size_t from_start = columns_.start.size();
  for (std::size_t j = 0; j < from_start; ++j)
    out.push_back({.index = columns_.start[j], .by = x_[run * from_start + j]});
  for (std::size_t j = 0; j < columns_.parameters.size(); ++j)
    out.push_back({.parameter = subject_.parameters[std::size_t(columns_.parameters[j])].name,
                   .by = x_[runs_.size() * from_start + j]});
  return out;
}

void PredictedRuns::fail(std::size_t run, const LinearisedMotion& motion) {
  failure_ = fmt::format("run {} fails after t = {:.6g}", run + 1, motion.time());
}

void PredictedRuns::predict(std::size_t run, std::size_t first, bool with_derivatives) try {
  const std::vector<Nudge> nudges = nudges_of(run);
  if (subject_.refusal) failure_ = subject_.refusal(nudges);
  if (!failure_.empty()) return;
  auto motion = subject_.begin(with_derivatives ? names_of(subject_, columns_) : std::vector<std::string>(), nudges);
  const Eigen::Index states = motion->states();
  Eigen::MatrixXd directions =
      with_derivatives ? directions_of(subject_, columns_, nudges, states) : Eigen::MatrixXd(states, 0);
  if (subject_.begin_along) subject_.begin_along(*motion, directions);
  Course course(std::move(motion), std::move(directions));
  const auto from_start = Eigen::Index(columns_.start.size()), by_parameters = Eigen::Index(columns_.parameters.size());
  std::optional<NodeValues> here;
  const MeasuredNumber* last = nullptr;
  for (std::size_t i = 0; i < runs_[run].size() && is_within(runs_[run][i]); ++i) {
    const MeasuredNumber& measured = runs_[run][i];
    if (last == nullptr || last->time != measured.time) here = course.at(measured);
    last = &measured;
    if (!here || !std::isfinite(here->values(measured.observed))) return fail(run, course.motion());
    const auto at = Eigen::Index(first + i);
    predicted_(at) = here->values(measured.observed);
    // An angle is as far off as the shorter way round.
    if (subject_.observed[std::size_t(measured.observed)].is_angle)
      predicted_(at) = measured.value + std::remainder(predicted_(at) - measured.value, 2 * std::numbers::pi);
    if (!with_derivatives) continue;
    const Eigen::RowVectorXd by = here->derivatives.row(measured.observed) * course.directions();
    derivatives_.block(at, Eigen::Index(run) * from_start, 1, from_start) = by.head(from_start);
    derivatives_.row(at).tail(by_parameters) = by.tail(by_parameters);
  }
} catch (const std::domain_error& error) {  // of parameters that a system cannot have
  failure_ = error.what();
} catch (const EventWithoutDerivative& error) {
  failure_ = error.what();
}

}  // namespace lagroid::app
