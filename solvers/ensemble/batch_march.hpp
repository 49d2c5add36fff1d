#pragma once
/// The members of one batch on their way: what `Integrator` does for one trajectory.

#include <lagroid/core/stepped.hpp>
#include <lagroid/solvers/ensemble/batch_extrapolation.hpp>
#include <lagroid/solvers/ensemble/batch_newton.hpp>
#include <lagroid/solvers/newton_step.hpp>
#include <lagroid/solvers/stepper.hpp>

#include <array>
#include <memory>

namespace lagroid {

/// As many trajectories of a system as a register has lanes. They take their steps together, each lane by its own
/// numbers alone: first guesses, iterations, compensated sums and branches are those of `Stepper` and `Walk`. A lane
/// whose step the batch does not solve is handed to `NewtonStep`, which damps, and to the continuation in the step
/// size; one that these do not solve either keeps its last state, and goes no further.
template <DiscreteSystem Sys, int W> class BatchMarch {
 public:
  using B = Batch<W>;
  using Mask = typename B::Mask;
  using G = typename Sys::GroupoidType;

  /// A lane's start. All are to be set; lanes that stand for no member repeat another one.
  void start(const Sys& system, int lane, const State<G>& state, const ArrowOf<G>& configuration, bool member) {
    const auto& groupoid = system.groupoid;
    auto object = groupoid.coordinates_of_object(state_.object);
    detail::set_lane(object, lane, groupoid.coordinates_of_object(state.object));
    const ObjectOf<G, B> at = groupoid.template object_at<B>(object);
    state_.object = at;
    detail::set_lane(state_.momentum, lane, state.momentum);
    detail::set_arrow_of_lane<W>(groupoid, configuration_, lane, configuration);
    status_[std::size_t(lane)] = member ? SolveStatus::converged : SolveStatus::not_converged;
  }

  /// One step of all that still go on.
  void advance(const Sys& system);

  /// Steps that a lane has taken.
  long index(int lane) const { return stopped(lane) ? stopped_at_[std::size_t(lane)] : index_; }
  /// Of all that go on.
  long index() const { return index_; }
  /// Converged while the lane goes on; then why it does not.
  SolveStatus status(int lane) const { return status_[std::size_t(lane)]; }

  State<G> state(const Sys& system, int lane) const {
    const auto& groupoid = system.groupoid;
    return {groupoid.template object_at<double>(detail::lane_of(groupoid.coordinates_of_object(state_.object), lane)),
            detail::lane_of(state_.momentum, lane)};
  }
  ArrowOf<G> configuration(const Sys& system, int lane) const {
    return detail::arrow_of_lane<W>(system.groupoid, configuration_, lane);
  }
  /// The arrow of the last step and its multipliers; of no meaning before the first.
  Step<Sys> step(const Sys& system, int lane) const {
    return {detail::arrow_of_lane<W>(system.groupoid, solution_.step.arrow, lane),
            detail::lane_of(solution_.step.multipliers, lane)};
  }

 private:
  static constexpr int n = Sys::dimension;
  static constexpr int size = Sys::dimension + Sys::constraints;
  using Unknowns = Vector<B, size>;
  using Fibre = AlgebroidVector<G, B>;

  bool stopped(int lane) const { return status_[std::size_t(lane)] != SolveStatus::converged; }
  Mask going() const {
    std::array<double, std::size_t(W)> lanes;
    for (int lane = 0; lane < W; ++lane) lanes[std::size_t(lane)] = stopped(lane) ? 0 : 1;
    return B::load(lanes.data()) > 0.0;
  }
  /// The arrow within half its own size of its prediction.
  static Mask near(const Fibre& predicted, const Fibre& solved) {
    const Fibre apart = solved - predicted;
    return apart.squaredNorm() <= 0.25 * max(solved.squaredNorm(), predicted.squaredNorm());
  }
  static Unknowns unknowns(const Fibre& chart, const Vector<B, Sys::constraints>& multipliers) {
    Unknowns out;
    out << chart, multipliers;
    return out;
  }

  void guess(const Sys& system);
  Mask first_step(const Sys& system, const Mask& wanted);
  Mask next_step(const Sys& system, const Mask& wanted);
  void rescue(const Sys& system, int lane, Mask& solved, Mask& anew);
  void join(const G& groupoid, const Mask& lanes);

  State<G, B> state_;
  ArrowOf<G, B> configuration_;
  Fibre momentum_carry_ = Fibre::Zero();
  Fibre carry_ = Fibre::Zero();
  StepSolution<Sys, B> solution_;
  BatchNewton<Sys, W> newton_;
  BatchExtrapolation<W, size, 7> past_;
  long index_ = 0;
  std::array<long, std::size_t(W)> stopped_at_{};
  std::array<SolveStatus, std::size_t(W)> status_{};
};

template <DiscreteSystem Sys, int W> LAGROID_FLATTEN void BatchMarch<Sys, W>::advance(const Sys& system) {
  const Mask wanted = going();
  const Step<Sys, B> before = solution_.step;
  Mask solved = index_ == 0 ? first_step(system, wanted) : next_step(system, wanted);
  Mask anew(index_ == 0);
  if (const Mask lost = wanted && !solved; xsimd::any(lost))
    for (int lane = 0; lane < W; ++lane)
      if (lost.get(std::size_t(lane))) rescue(system, lane, solved, anew);
  const Unknowns found = unknowns(system.groupoid.chart(solution_.step.arrow), solution_.step.multipliers);
  if (index_ == 0) {
    past_.start(found);
  } else {
    past_.push(found, solved, anew);
  }
  join(system.groupoid, solved);
  detail::blend_arrow(system.groupoid, !solved, before.arrow, solution_.step.arrow);
  detail::blend(!solved, before.multipliers, solution_.step.multipliers);
  ++index_;
}

/// The guess of a step without predecessor: the system's own, else the unit arrow.
template <DiscreteSystem Sys, int W> void BatchMarch<Sys, W>::guess(const Sys& system) {
  Step<Sys, B>& step = solution_.step;
  if constexpr (HasFirstGuess<Sys>) {
    for (int lane = 0; lane < W; ++lane) {
      const Step<Sys> first = system.first_guess(state(system, lane));
      detail::set_arrow_of_lane<W>(system.groupoid, step.arrow, lane, first.arrow);
      detail::set_lane(step.multipliers, lane, typename Sys::Multipliers(first.multipliers));
    }
  } else {
    const ArrowOf<G, B> unit = system.groupoid.unit(state_.object);
    step.arrow = unit;
    for (int a = 0; a < Sys::constraints; ++a) step.multipliers(a) = B(0.0);
  }
}

/// By doubling the step from a small one, as `Stepper` does.
template <DiscreteSystem Sys, int W>
[[gnu::cold, gnu::noinline]] auto BatchMarch<Sys, W>::first_step(const Sys& system, const Mask& wanted) -> Mask {
  if constexpr (HasTimeStep<Sys>) {
    constexpr double smallest = 1.0 / 64;
    Sys scaled = system;
    scaled.h = smallest * system.h;
    guess(scaled);
    Mask solved = newton_.solve_fully(scaled, state_, solution_, wanted);
    for (double fraction = 2 * smallest; fraction <= 1; fraction *= 2) {
      scaled.h = fraction * system.h;
      const Fibre predicted = system.groupoid.chart(solution_.step.arrow) * 2.0;
      const ArrowOf<G, B> arrow = system.groupoid.arrow_in_chart(state_.object, predicted);
      solution_.step.arrow = arrow;
      solved = newton_.solve_fully(scaled, state_, solution_, solved);
      solved = solved && near(predicted, system.groupoid.chart(solution_.step.arrow));
    }
    return solved;
  } else {
    guess(system);
    return newton_.solve_fully(system, state_, solution_, wanted);
  }
}

template <DiscreteSystem Sys, int W>
auto BatchMarch<Sys, W>::next_step(const Sys& system, const Mask& wanted) -> Mask {
  const Unknowns predicted = past_.next();
  const Fibre chart = predicted.template head<n>();
  const ArrowOf<G, B> arrow = system.groupoid.arrow_in_chart(state_.object, chart);
  solution_.step.arrow = arrow;
  solution_.step.multipliers = predicted.template tail<Sys::constraints>();
  const Mask solved = newton_.solve(system, state_, solution_, wanted);
  return solved && near(chart, system.groupoid.chart(solution_.step.arrow));
}

/// A lane that the batch did not solve, by itself: the damped iteration from the same guess and, where that fails or
/// ends far from it, the solution that is continuous in the step size.
template <DiscreteSystem Sys, int W>
[[gnu::cold, gnu::noinline]] void BatchMarch<Sys, W>::rescue(const Sys& system, int lane, Mask& solved, Mask& anew) {
  const auto& groupoid = system.groupoid;
  const State<G> from = state(system, lane);
  StepSolution<Sys> solution;
  StepReport before;
  bool restarted = true;
  if (index_ > 0) {
    const Unknowns predicted = past_.next();
    const AlgebroidVector<G> chart = detail::lane_of(predicted, lane).template head<n>();
    const ArrowOf<G> arrow = groupoid.arrow_in_chart(from.object, chart);
    solution.step = {arrow, detail::lane_of(predicted, lane).template tail<Sys::constraints>()};
    before = NewtonStep<Sys>().solve(system, from, solution);
    if (before.converged()) {
      const AlgebroidVector<G> found = groupoid.chart(solution.step.arrow);
      restarted = (found - chart).squaredNorm() > 0.25 * std::max(found.squaredNorm(), chart.squaredNorm());
    }
  }
  StepReport report = before;
  if (restarted) {
    StepSolution<Sys> continued;
    report = Stepper<Sys>(system, std::make_unique<NewtonStep<Sys>>()).solve(from, continued);
    if (report.converged()) {
      solution = continued;
    } else if (before.converged()) {
      report = before;
    }
  }
  if (!report.converged()) {
    status_[std::size_t(lane)] = report.status;
    stopped_at_[std::size_t(lane)] = index_;
    return;
  }
  detail::set_arrow_of_lane<W>(groupoid, solution_.step.arrow, lane, solution.step.arrow);
  detail::set_lane(solution_.step.multipliers, lane, solution.step.multipliers);
  detail::set_lane(solution_.momentum_change, lane, solution.momentum_change);
  detail::set_lane(solution_.remainder, lane, solution.remainder);
  B here = 0.0;
  here.set(lane, 1.0);
  const Mask only = here > 0.0;
  newton_.renew(only);
  solved = solved || only;
  if (restarted) anew = anew || only;
}

/// Joins the arrow of the step to the walk of the lanes given (see `Walk`).
template <DiscreteSystem Sys, int W> void BatchMarch<Sys, W>::join(const G& groupoid, const Mask& lanes) {
  const Fibre change = momentum_carry_ + solution_.momentum_change;
  const Fibre momentum = state_.momentum + change;
  detail::blend(lanes, Fibre(change - (momentum - state_.momentum)), momentum_carry_);
  detail::blend(lanes, momentum, state_.momentum);
  ArrowOf<G, B> reached = groupoid.multiply(configuration_, solution_.step.arrow);
  const Fibre carry = groupoid.nudge(reached, Fibre(carry_ + solution_.remainder));
  detail::blend(lanes, carry, carry_);
  const ArrowOf<G, B> projected = groupoid.project(reached);
  detail::blend_arrow(groupoid, lanes, projected, configuration_);
  const ObjectOf<G, B> object = groupoid.target(configuration_);
  state_.object = object;
}

}  // namespace lagroid
