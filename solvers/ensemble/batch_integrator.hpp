#pragma once
/// The members of one batch, integrated together, each in its own lane: the map of fixed_step_integrator.hpp over the
/// scalar Batch. A lane that the batch does not solve is solved alone, by NewtonStep; one that fails then keeps its
/// last state, with a status. `start` is required for every lane. Ensemble has the batches.

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/scalars/compensation.hpp>
#include <lagroid/solvers/ensemble/batch_extrapolation.hpp>
#include <lagroid/solvers/ensemble/batch_newton.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/solvers/step/step_predictor.hpp>

#include <array>
#include <memory>

namespace lagroid {

/// As many trajectories of a system as a register has lanes. They take their steps together, each lane by its own
/// numbers alone: first guesses, iterations, compensated sums and branches are those of `StepPredictor` and
/// `CompensatedTrajectory`. A lane whose step the batch does not solve is handed to `NewtonStep`, which damps, and to
/// the continuation in the step size; one that these do not solve either keeps its last state, and goes no further.
template <DiscreteSystem Sys, int W> class BatchIntegrator {
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

  /// A lane goes no further.
  void end(int lane) {
    stopped_at_[std::size_t(lane)] = index(lane);
    ended_[std::size_t(lane)] = true;
  }
  /// Whether a lane takes the next step.
  bool goes_on(int lane) const {
    return status_[std::size_t(lane)] == SolveStatus::converged && !ended_[std::size_t(lane)];
  }
  /// Steps that a lane has taken.
  long index(int lane) const { return goes_on(lane) ? index_ : stopped_at_[std::size_t(lane)]; }
  /// Of all that go on.
  long index() const { return index_; }
  /// Converged, unless a step failed: then why.
  SolveStatus status(int lane) const { return status_[std::size_t(lane)]; }

  /// Of all lanes.
  const State<G, B>& states() const { return state_; }
  State<G> state(const Sys& system, int lane) const { return detail::state_of_lane<W>(system.groupoid, state_, lane); }
  ArrowOf<G> configuration(const Sys& system, int lane) const {
    return detail::arrow_of_lane<W>(system.groupoid, configuration_, lane);
  }
  /// The arrow of the last step and its multipliers; of no meaning before the first.
  Step<Sys> step(const Sys& system, int lane) const {
    return {detail::arrow_of_lane<W>(system.groupoid, step_.arrow, lane), detail::lane_of(step_.multipliers, lane)};
  }

 private:
  static constexpr int n = Sys::dimension;
  static constexpr int size = Sys::dimension + Sys::constraints;
  using Unknowns = Vector<B, size>;
  using Fibre = AlgebroidVector<G, B>;

  Mask going() const {
    std::array<double, std::size_t(W)> lanes;
    for (int lane = 0; lane < W; ++lane) lanes[std::size_t(lane)] = goes_on(lane) ? 1 : 0;
    return B::load(lanes.data()) > 0.0;
  }
  /// The arrow within half its own size of its prediction.
  static Mask near(const Fibre& predicted, const Fibre& solved) {
    const Fibre apart = solved - predicted;
    return apart.squaredNorm() <= 0.25 * max(solved.squaredNorm(), predicted.squaredNorm());
  }

  Step<Sys, B> guess(const Sys& system) const;
  Step<Sys, B> along(const Sys& system, const Unknowns& unknowns) const;
  Mask first_step(const Sys& system, const Mask& wanted, StepSolution<Sys, B>& solution);
  Mask next_step(const Sys& system, const Mask& wanted, StepSolution<Sys, B>& solution);
  Mask again(const Sys& system, const Mask& wanted, StepSolution<Sys, B>& solution);
  void rescue(const Sys& system, int lane, StepSolution<Sys, B>& solution, Mask& solved, Mask& anew);
  void join(const G& groupoid, const StepSolution<Sys, B>& solution, const Mask& lanes);

  State<G, B> state_;
  ArrowOf<G, B> configuration_;
  Compensation<Fibre> momentum_compensation_{Fibre::Zero()};
  Fibre place_compensation_ = Fibre::Zero();
  Step<Sys, B> step_;  ///< the last
  BatchNewton<Sys, W> newton_;
  BatchExtrapolation<W, size, 7> past_;
  long index_ = 0;
  std::array<long, std::size_t(W)> stopped_at_{};
  std::array<SolveStatus, std::size_t(W)> status_{};
  std::array<bool, std::size_t(W)> ended_{};
};

template <DiscreteSystem Sys, int W> LAGROID_FLATTEN void BatchIntegrator<Sys, W>::advance(const Sys& system) {
  const auto& groupoid = system.groupoid;
  const Mask wanted = going();
  StepSolution<Sys, B> solution;
  Mask solved = index_ == 0 ? first_step(system, wanted, solution) : next_step(system, wanted, solution);
  Mask anew(index_ == 0);
  if (const Mask lost = wanted && !solved; xsimd::any(lost))
    for (int lane = 0; lane < W; ++lane)
      if (lost.get(std::size_t(lane))) rescue(system, lane, solution, solved, anew);
  Unknowns found;
  found << groupoid.chart(solution.step.arrow), solution.step.multipliers;
  if (index_ == 0) {
    past_.start(found);
  } else {
    past_.push(found, solved, anew);
  }
  join(groupoid, solution, solved);
  ++index_;
}

/// The guess of a step without predecessor: the system's own, else the unit arrow.
template <DiscreteSystem Sys, int W> auto BatchIntegrator<Sys, W>::guess(const Sys& system) const -> Step<Sys, B> {
  Step<Sys, B> step{system.groupoid.unit(state_.object), Vector<B, Sys::constraints>::Zero()};
  if constexpr (HasFirstGuess<Sys>)
    for (int lane = 0; lane < W; ++lane) {
      const Step<Sys> first = system.first_guess(state(system, lane));
      detail::set_arrow_of_lane<W>(system.groupoid, step.arrow, lane, first.arrow);
      detail::set_lane(step.multipliers, lane, typename Sys::Multipliers(first.multipliers));
    }
  return step;
}
/// The step with these unknowns.
template <DiscreteSystem Sys, int W>
auto BatchIntegrator<Sys, W>::along(const Sys& system, const Unknowns& unknowns) const -> Step<Sys, B> {
  return {system.groupoid.arrow_in_chart(state_.object, Fibre(unknowns.template head<n>())),
          unknowns.template tail<Sys::constraints>()};
}

/// By doubling the step from a small one, as `StepPredictor` does.
template <DiscreteSystem Sys, int W>
[[gnu::cold, gnu::noinline]] auto BatchIntegrator<Sys, W>::first_step(const Sys& system, const Mask& wanted,
                                                                      StepSolution<Sys, B>& solution) -> Mask {
  if constexpr (HasTimeStep<Sys>) {
    constexpr double smallest = 1.0 / 64;
    Sys scaled = system;
    scaled.h = smallest * system.h;
    solution.step = guess(scaled);
    Mask solved = newton_.solve_fully(scaled, state_, solution, wanted);
    for (double fraction = 2 * smallest; fraction <= 1; fraction *= 2) {
      scaled.h = fraction * system.h;
      const Fibre chart = system.groupoid.chart(solution.step.arrow) * 2.0;
      const ArrowOf<G, B> arrow = system.groupoid.arrow_in_chart(state_.object, chart);
      solution.step.arrow = arrow;
      solved = newton_.solve_fully(scaled, state_, solution, solved);
      solved = solved && near(chart, system.groupoid.chart(solution.step.arrow));
    }
    return solved;
  } else {
    solution.step = guess(system);
    return newton_.solve_fully(system, state_, solution, wanted);
  }
}

template <DiscreteSystem Sys, int W>
auto BatchIntegrator<Sys, W>::next_step(const Sys& system, const Mask& wanted, StepSolution<Sys, B>& solution) -> Mask {
  const Unknowns predicted = past_.next();
  const Fibre chart = predicted.template head<n>();
  solution.step = along(system, predicted);
  Mask solved = newton_.solve(system, state_, solution, wanted);
  if (const Mask lost = wanted && !solved; xsimd::any(lost)) solved = solved || again(system, lost, solution);
  return solved && near(chart, system.groupoid.chart(solution.step.arrow));
}

/// Lanes that the kept matrices did not solve, from the same guess with new ones.
template <DiscreteSystem Sys, int W>
[[gnu::cold, gnu::noinline]] auto BatchIntegrator<Sys, W>::again(const Sys& system, const Mask& wanted,
                                                                 StepSolution<Sys, B>& solution) -> Mask {
  StepSolution<Sys, B> fresh;
  fresh.step = along(system, past_.next());
  const Mask solved = newton_.solve_fully(system, state_, fresh, wanted);
  detail::blend_arrow(system.groupoid, wanted, fresh.step.arrow, solution.step.arrow);
  detail::blend(wanted, fresh.step.multipliers, solution.step.multipliers);
  detail::blend(wanted, fresh.momentum_change, solution.momentum_change);
  detail::blend(wanted, fresh.remainder, solution.remainder);
  return solved;
}

/// A lane that the batch did not solve, by itself: the damped iteration from the same guess and, where that fails or
/// ends far from it, the solution that is continuous in the step size.
template <DiscreteSystem Sys, int W>
[[gnu::cold, gnu::noinline]] void BatchIntegrator<Sys, W>::rescue(const Sys& system, int lane,
                                                                  StepSolution<Sys, B>& solution, Mask& solved,
                                                                  Mask& anew) {
  const auto& groupoid = system.groupoid;
  const State<G> from = state(system, lane);
  StepSolution<Sys> found;
  StepReport report;
  bool near_guess = false;
  if (index_ > 0) {
    const Step<Sys, B> guesses = along(system, past_.next());
    found.step = {detail::arrow_of_lane<W>(groupoid, guesses.arrow, lane), detail::lane_of(guesses.multipliers, lane)};
    const AlgebroidVector<G> guess = groupoid.chart(found.step.arrow);
    report = NewtonStep<Sys>().solve(system, from, found);
    const AlgebroidVector<G> end = groupoid.chart(found.step.arrow);
    near_guess = (end - guess).squaredNorm() <= 0.25 * std::max(end.squaredNorm(), guess.squaredNorm());
  }
  if (!report.converged() || !near_guess) {
    StepSolution<Sys> continued;
    const StepReport restarted = StepPredictor<Sys>(system, std::make_unique<NewtonStep<Sys>>()).solve(from, continued);
    if (restarted.converged()) found = continued;
    if (restarted.converged() || !report.converged()) report = restarted;
  }
  if (!report.converged()) {
    status_[std::size_t(lane)] = report.status;
    stopped_at_[std::size_t(lane)] = index_;
    return;
  }
  detail::set_arrow_of_lane<W>(groupoid, solution.step.arrow, lane, found.step.arrow);
  detail::set_lane(solution.step.multipliers, lane, found.step.multipliers);
  detail::set_lane(solution.momentum_change, lane, found.momentum_change);
  detail::set_lane(solution.remainder, lane, found.remainder);
  B here = 0.0;
  here.set(lane, 1.0);
  const Mask only = here > 0.0;
  newton_.renew(only);
  solved = solved || only;
  if (!near_guess) anew = anew || only;
}

/// Joins the arrow of the step to the trajectories of the lanes given (see `CompensatedTrajectory`).
template <DiscreteSystem Sys, int W>
void BatchIntegrator<Sys, W>::join(const G& groupoid, const StepSolution<Sys, B>& solution, const Mask& lanes) {
  detail::blend_arrow(groupoid, lanes, solution.step.arrow, step_.arrow);
  detail::blend(lanes, solution.step.multipliers, step_.multipliers);
  Compensation<Fibre> compensation = momentum_compensation_;
  Fibre momentum = state_.momentum;
  compensation.add(momentum, solution.momentum_change);
  detail::blend(lanes, compensation.lost, momentum_compensation_.lost);
  detail::blend(lanes, momentum, state_.momentum);
  ArrowOf<G, B> reached = groupoid.multiply(configuration_, solution.step.arrow);
  const Fibre lost = groupoid.correct(reached, Fibre(place_compensation_ + solution.remainder));
  detail::blend(lanes, lost, place_compensation_);
  const ArrowOf<G, B> projected = groupoid.project(reached);
  detail::blend_arrow(groupoid, lanes, projected, configuration_);
  const ObjectOf<G, B> object = groupoid.target(configuration_);
  state_.object = object;
}

}  // namespace lagroid
