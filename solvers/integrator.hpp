#pragma once
/// The one-step map on A*G: (q, mu) -> g -> (q', mu').

#include <lagroid/core/quantity.hpp>
#include <lagroid/solvers/constrained_momentum.hpp>
#include <lagroid/solvers/extrapolation.hpp>
#include <lagroid/solvers/step_solver.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace lagroid {

/// mu with the part removed that leaves C^{-1}(0) (RATTLE's second stage): mu + nu . dC o rho with nu such that
/// dC o rho W mu = 0, where W = (-d2L/dv dw)^{-1} at the unit arrow is the inverse mass matrix up to a factor.
/// For nonholonomic and forced systems see constrained_momentum; the identity for others without object constraints.
/// The dynamics is the same with and without it; the projected momentum is the one in which the map is symplectic on
/// T*C^{-1}(0).
template <DiscreteSystem Sys>
AlgebroidVector<typename Sys::GroupoidType> tangent_momentum(const Sys& system,
                                                             const State<typename Sys::GroupoidType>& state) {
  if constexpr (Nonholonomic<Sys> || (Forced<Sys> && Sys::arrow_constraints == 0 && Sys::object_constraints > 0)) {
    return constrained_momentum(system, state);
  } else if constexpr (Sys::object_constraints == 0) {
    return state.momentum;
  } else {
    constexpr int k = Sys::object_constraints;
    const auto d = two_sided(system, system.groupoid.unit(state.object), Sys::Multipliers::Zero().eval());
    const Matrix<double, Sys::dimension, k> normal = -d.constraint_source.template rightCols<k>();
    const Eigen::PartialPivLU<Matrix<double, Sys::dimension, Sys::dimension>> mass(-d.mixed);
    const Matrix<double, Sys::dimension, k> w_normal = mass.solve(normal);
    const Vector<double, k> nu =
        (normal.transpose() * w_normal).partialPivLu().solve(w_normal.transpose() * state.momentum);
    return state.momentum - normal * nu;
  }
}

/// Marches a discrete constrained Lagrangian system. A step that does not converge leaves everything as it was.
///
/// The momentum is updated by its increment, mu' = mu + (F+ - F-)(g, lambda): equal to F+ at a solution, and free of
/// the solve's residual. Momenta on which the Lagrangian does not depend are then kept to the last bit.
template <DiscreteSystem Sys> class Integrator {
 public:
  using G = typename Sys::GroupoidType;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint).
  Integrator(Sys system, State<G> initial, ArrowOf<G> configuration, std::unique_ptr<StepSolver<Sys>> solver)
      : system_(std::move(system)), solver_(std::move(solver)) {
    point_.state = std::move(initial);
    point_.configuration = std::move(configuration);
    point_.step = {system_.groupoid.unit(point_.state.object), Sys::Multipliers::Zero()};
  }

  const TrajectoryPoint<Sys>& point() const { return point_; }
  const Sys& system() const { return system_; }

  StepReport advance();

 private:
  /// A guess with no predecessor: the system's own, else the unit arrow.
  Step<Sys> guess(const Sys& system) const {
    if constexpr (HasFirstGuess<Sys>) {
      return system.first_guess(point_.state);
    } else {
      return {system.groupoid.unit(point_.state.object), Sys::Multipliers::Zero()};
    }
  }

  StepReport restart(StepSolution<Sys>& found, const StepReport& before);
  StepReport first_step(StepSolution<Sys>& solution);
  StepReport continue_in_step_size(StepSolution<Sys>& solution);
  void accept(const StepSolution<Sys>& solution, const AlgebroidVector<G>& chart);

  /// Whether a solve stayed on the branch it was continued along: the arrow within half its own size of its prediction.
  static bool near(const AlgebroidVector<G>& predicted, const AlgebroidVector<G>& solved) {
    return (solved - predicted).squaredNorm() <= 0.25 * std::max(solved.squaredNorm(), predicted.squaredNorm());
  }

  using Unknowns = Vector<double, Sys::dimension + Sys::constraints>;
  static constexpr int extrapolation_degree = 7;

  Sys system_;
  std::unique_ptr<StepSolver<Sys>> solver_;
  TrajectoryPoint<Sys> point_;
  AlgebroidVector<G> momentum_carry_ = AlgebroidVector<G>::Zero();
  AlgebroidVector<G> carry_ = AlgebroidVector<G>::Zero();
  Extrapolation<Sys::dimension + Sys::constraints, extrapolation_degree> past_;
};

template <DiscreteSystem Sys> LAGROID_FLATTEN StepReport Integrator<Sys>::advance() {
  StepSolution<Sys> solution;
  if (point_.index == 0) return restart(solution, {});
  const Unknowns predicted = past_.next();
  const AlgebroidVector<G> v = predicted.template head<Sys::dimension>();
  const ArrowOf<G> arrow = system_.groupoid.arrow_in_chart(point_.state.object, v);
  solution.step.arrow = arrow;
  solution.step.multipliers = predicted.template tail<Sys::constraints>();
  const StepReport report = solver_->solve(system_, point_.state, solution);
  if (report.converged()) {
    const AlgebroidVector<G> solved = system_.groupoid.chart(solution.step.arrow);
    if (near(v, solved)) {
      accept(solution, solved);
      return report;
    }
  }
  return restart(solution, report);
}

/// A step without predecessor, or one whose solve failed or ended far from the predicted arrow: the solution that is
/// continuous in the step size; if there is none, what the solve before found.
template <DiscreteSystem Sys>
[[gnu::cold, gnu::noinline]] StepReport Integrator<Sys>::restart(StepSolution<Sys>& found, const StepReport& before) {
  StepSolution<Sys> solution;
  StepReport report = first_step(solution);
  report.iterations += before.iterations;
  if (!report.converged() && before.converged()) {
    report = before;
    solution = found;
  }
  if (report.converged()) {
    past_.clear();
    accept(solution, system_.groupoid.chart(solution.step.arrow));
  }
  return report;
}

template <DiscreteSystem Sys> StepReport Integrator<Sys>::first_step(StepSolution<Sys>& solution) {
  int iterations = 0;
  if constexpr (HasTimeStep<Sys>) {
    const StepReport continued = continue_in_step_size(solution);
    if (continued.converged()) return continued;
    iterations = continued.iterations;
  }
  solution.step = guess(system_);
  StepReport direct = solver_->solve(system_, point_.state, solution);
  direct.iterations += iterations;
  return direct;
}

/// The solution that is continuous in the step size: from a small h, where the guess is near it, up to h. (At a large
/// h an implicit step has several solutions, and the nearest to the guess may be another.)
template <DiscreteSystem Sys> StepReport Integrator<Sys>::continue_in_step_size(StepSolution<Sys>& solution) {
  constexpr double start = 1.0 / 64;
  constexpr double smallest_factor = 1.01;
  const auto& groupoid = system_.groupoid;
  Sys scaled = system_;
  double fraction = start;
  scaled.h = fraction * system_.h;
  solution.step = guess(scaled);
  StepReport report = solver_->solve(scaled, point_.state, solution);
  int iterations = report.iterations;
  double factor = 2;
  while (report.converged() && fraction < 1) {
    const double next = std::min(1.0, fraction * factor);
    scaled.h = next == 1 ? system_.h : next * system_.h;
    const AlgebroidVector<G> v = groupoid.chart(solution.step.arrow) * (next / fraction);
    StepSolution<Sys> trial;
    trial.step = {groupoid.arrow_in_chart(point_.state.object, v), solution.step.multipliers};
    StepReport attempt = solver_->solve(scaled, point_.state, trial);
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

/// `chart` is the arrow in the groupoid's chart.
template <DiscreteSystem Sys>
void Integrator<Sys>::accept(const StepSolution<Sys>& solution, const AlgebroidVector<G>& chart) {
  const auto& groupoid = system_.groupoid;
  const auto& arrow = solution.step.arrow;
  point_.step = solution.step;

  // Compensated accumulation: what rounding took so far is given back as soon as it can be stored.
  momentum_carry_ += solution.momentum_change;
  const AlgebroidVector<G> momentum = point_.state.momentum + momentum_carry_;
  momentum_carry_ -= momentum - point_.state.momentum;
  point_.state.momentum = momentum;
  ArrowOf<G> reached = groupoid.compose(point_.configuration, arrow);
  carry_ = groupoid.nudge(reached, AlgebroidVector<G>(carry_ + solution.remainder));
  const ArrowOf<G> projected = groupoid.project(reached);
  point_.configuration = projected;
  const ObjectOf<G> object = groupoid.target(projected);
  point_.state.object = object;
  Unknowns unknowns;
  unknowns << chart, solution.step.multipliers;
  past_.push(unknowns);
  ++point_.index;
  if constexpr (HasTimeStep<Sys>) point_.time = double(point_.index) * system_.h;
}

}  // namespace lagroid
