#pragma once
/// Solves the steps of a trajectory one after another: it chooses where each solve starts and which solution is taken.
///
///     x_{k+1} ~ sum_j (-1)^j binomial(m + 1, j + 1) x_{k-j},    x = (chart of the arrow, multipliers).
///
/// A good first guess saves most iterations, and an implicit step at a large h has several solutions, of which only the
/// one that is continuous in h belongs to the motion.
///
///     const Kepler kepler;
///     StepPredictor<Kepler> predictor(kepler, make_step_solver(kepler, StepMethod::newton));
///     StepSolution<Kepler> first;
///     const StepReport report = predictor.solve({{1, 0}, {0, 1}}, first);
///
/// Requires states that follow each other smoothly; call `forget` after a jump. The report is that of the solver, with
/// the iterations of all attempts; `left_domain` also where the solution found is another than the continuous one. A
/// step that does not converge is not remembered. An optional member of the system that does not fit does not compile.

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/derivatives/gradient_check.hpp>
#include <lagroid/solvers/step/extrapolation.hpp>
#include <lagroid/solvers/step/optional_members.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace lagroid {

/// Solves the steps of a trajectory. Each starts from the continuation of those before; a step with no predecessor, or
/// one that ends far from where it was expected, is continued in the step size from a small one, because at a large one
/// an implicit step has several solutions.
template <DiscreteSystem Sys> class StepPredictor {
 public:
  using G = typename Sys::GroupoidType;

  StepPredictor(Sys system, std::unique_ptr<StepSolver<Sys>> solver)
      : system_(std::move(system)), solver_(std::move(solver)) {
    require_optional_members_to_fit<Sys>();
  }

  const Sys& system() const { return system_; }
  /// For a step or a time that changes from one step to the next. Smoothly, or `forget` what was.
  Sys& system() { return system_; }

  /// The step from `state`. One that does not converge is not remembered.
  StepReport solve(const State<G>& state, StepSolution<Sys>& solution);
  void forget() { past_.clear(); }
  /// Visits all that the next solve goes on from.
  void serialize(NumberArchive& archive) {
    if (has_time_step(system_)) {
      double h = time_step(system_);
      archive(h);
      set_time_step(system_, h);
    }
    if constexpr (TimeDependent<Sys>) archive(system_.time);
    past_.serialize(archive);
    solver_->serialize(archive);
  }

 private:
  /// A guess with no predecessor: the system's own, else the unit arrow.
  static Step<Sys> guess(const Sys& system, const State<G>& state) {
    if constexpr (HasFirstGuess<Sys>) {
      return system.first_guess(state);
    } else {
      return {system.groupoid.unit(state.object), Sys::Multipliers::Zero()};
    }
  }

  StepReport restart(const State<G>& state, StepSolution<Sys>& found, const StepReport& before);
  StepReport first_step(const State<G>& state, StepSolution<Sys>& solution);
  StepReport continue_in_step_size(const State<G>& state, StepSolution<Sys>& solution);

  /// Whether a solve stayed on the branch it was continued along: the arrow within half its own size of its prediction.
  static bool near(const AlgebroidVector<G>& predicted, const AlgebroidVector<G>& solved) {
    double difference = 0;
    double of_solved = 0;
    double of_predicted = 0;
    unrolled<Sys::dimension>([&]<int I>() {
      difference += (solved(I) - predicted(I)) * (solved(I) - predicted(I));
      of_solved += solved(I) * solved(I);
      of_predicted += predicted(I) * predicted(I);
    });
    return difference <= 0.25 * std::max(of_solved, of_predicted);
  }

  using Unknowns = Vector<double, Sys::dimension + Sys::constraints>;
  static constexpr int extrapolation_degree = 7;

  /// `chart` is the arrow in the groupoid's chart.
  void remember(const AlgebroidVector<G>& chart, const typename Sys::Multipliers& multipliers) {
    Unknowns unknowns;
    unrolled<Sys::dimension>([&]<int I>() { unknowns(I) = chart(I); });
    unrolled<Sys::constraints>([&]<int I>() { unknowns(Sys::dimension + I) = multipliers(I); });
    past_.push(unknowns);
  }

  Sys system_;
  std::unique_ptr<StepSolver<Sys>> solver_;
  Extrapolation<Sys::dimension + Sys::constraints, extrapolation_degree> past_;
};

template <DiscreteSystem Sys>
LAGROID_FLATTEN StepReport StepPredictor<Sys>::solve(const State<G>& state, StepSolution<Sys>& solution) {
  if (past_.empty()) return restart(state, solution, {});
  const Unknowns predicted = past_.next();
  AlgebroidVector<G> v;
  unrolled<Sys::dimension>([&]<int I>() { v(I) = predicted(I); });
  const ArrowOf<G> arrow = system_.groupoid.arrow_in_chart(state.object, v);
  solution.step.arrow = arrow;
  unrolled<Sys::constraints>([&]<int I>() { solution.step.multipliers(I) = predicted(Sys::dimension + I); });
  const StepReport report = solver_->solve(system_, state, solution);
  if (report.converged()) {
    const AlgebroidVector<G> solved = system_.groupoid.chart(solution.step.arrow);
    if (near(v, solved)) {
      remember(solved, solution.step.multipliers);
      return report;
    }
  }
  return restart(state, solution, report);
}

/// A step without predecessor, or one whose solve failed or ended far from the predicted arrow: the solution that is
/// continuous in the step size; if there is none, what the solve before found.
template <DiscreteSystem Sys>
[[gnu::cold, gnu::noinline]] StepReport StepPredictor<Sys>::restart(const State<G>& state, StepSolution<Sys>& found,
                                                                    const StepReport& before) {
  StepSolution<Sys> solution;
  StepReport report = first_step(state, solution);
  if constexpr (checked_build) check_gradient(system_, solution.step);
  report.iterations += before.iterations;
  if (report.converged()) {
    found = solution;
  } else if (before.converged()) {
    report = before;
  }
  if (report.converged()) {
    past_.clear();
    remember(system_.groupoid.chart(found.step.arrow), found.step.multipliers);
  }
  return report;
}

template <DiscreteSystem Sys>
StepReport StepPredictor<Sys>::first_step(const State<G>& state, StepSolution<Sys>& solution) {
  int iterations = 0;
  if (has_time_step(system_)) {
    const StepReport continued = continue_in_step_size(state, solution);
    if (continued.converged()) return continued;
    iterations = continued.iterations;
  }
  solution.step = guess(system_, state);
  StepReport direct = solver_->solve(system_, state, solution);
  direct.iterations += iterations;
  return direct;
}

/// The solution that is continuous in the step size: from a small h, where the guess is near it, up to h. (At a large
/// h an implicit step has several solutions, and the nearest to the guess may be another.)
template <DiscreteSystem Sys>
StepReport StepPredictor<Sys>::continue_in_step_size(const State<G>& state, StepSolution<Sys>& solution) {
  constexpr double start = 1.0 / 64;
  constexpr double smallest_factor = 1.01;
  const auto& groupoid = system_.groupoid;
  Sys scaled = system_;
  double fraction = start;
  const double h = time_step(system_);
  set_time_step(scaled, fraction * h);
  solution.step = guess(scaled, state);
  StepReport report = solver_->solve(scaled, state, solution);
  int iterations = report.iterations;
  double factor = 2;
  while (report.converged() && fraction < 1) {
    const double next = std::min(1.0, fraction * factor);
    set_time_step(scaled, next == 1 ? h : next * h);
    const AlgebroidVector<G> v = groupoid.chart(solution.step.arrow) * (next / fraction);
    StepSolution<Sys> trial;
    trial.step = {groupoid.arrow_in_chart(state.object, v), solution.step.multipliers};
    StepReport attempt = solver_->solve(scaled, state, trial);
    iterations += attempt.iterations;
    if (attempt.converged() && near(v, groupoid.chart(trial.step.arrow))) {
      report = attempt;
      solution = trial;
      fraction = next;
      factor = std::min(2.0, factor * factor);
    } else if (factor > smallest_factor) {
      factor = std::sqrt(factor);
    } else {
      report = attempt;
      if (attempt.converged()) report.status = SolveStatus::left_domain;
    }
  }
  report.iterations = iterations;
  return report;
}

}  // namespace lagroid
