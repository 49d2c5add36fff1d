#pragma once
/// The state that a sequence of solved steps leads to, summed with compensation (Kahan):
///
///     q' = beta(g),    mu' = mu + (F+ - F-)(g, lambda),    configuration' = configuration g,    t' = t + h.
///
/// Over millions of steps plain sums would lose digits, and F+ itself would add the residual of every solve.
///
///     StepSolution<Kepler> solution;  // of a StepSolver
///     CompensatedTrajectory<Kepler> orbit({}, {{1, 0}, {0, 1}}, Pair<2>::unit(Vector<double, 2>(1, 0)));
///     orbit.join({}, solution);
///     orbit.arrive(0.01);
///
/// Requires solutions that converged, each from the state that the last one led to. The constructor throws
/// std::invalid_argument where the configuration does not end at the initial object.

#include <lagroid/core/quantity.hpp>
#include <lagroid/core/scalars/compensation.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

namespace lagroid {

/// The state, configuration and time that a sequence of solved steps leads to.
///
/// The momentum is updated by its increment, mu' = mu + (F+ - F-)(g, lambda): equal to F+ at a solution, and free of
/// the solve's residual. Momenta on which the Lagrangian does not depend are then kept to the last bit. Objects,
/// momenta and times are sums with compensation.
template <DiscreteSystem Sys> class CompensatedTrajectory {
 public:
  using G = typename Sys::GroupoidType;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint). Throws
  /// std::invalid_argument where it ends elsewhere.
  CompensatedTrajectory(const G& groupoid, const State<G>& initial, const ArrowOf<G>& configuration, double start = 0) {
    groupoid.require_initial_end(configuration, initial.object);
    point_.time = start;
    point_.state = initial;
    point_.configuration = configuration;
    point_.step = {groupoid.unit(initial.object), Sys::Multipliers::Zero()};
  }

  const TrajectoryPoint<Sys>& point() const { return point_; }

  /// Joins an arrow to the trajectory.
  void join(const G& groupoid, const StepSolution<Sys>& solution);

  /// Ends a step of however many arrows at the next point, `step_size` later.
  void arrive(double step_size) {
    ++point_.index;
    point_.step_size = step_size;
    time_compensation_.add(point_.time, step_size);
  }
  /// The same at a known time, the last arrow's step given.
  void arrive_at(double time, double step_size) {
    ++point_.index;
    point_.step_size = step_size;
    point_.time = time;
  }

  /// Goes on from a point that it did not lead to.
  void go_on_from(const TrajectoryPoint<Sys>& point) {
    point_ = point;
    momentum_compensation_.lost.setZero();
    place_compensation_.setZero();
  }

  /// Visits all that it goes on from.
  void serialize(const G& groupoid, NumberArchive& archive) {
    point_.serialize(groupoid, archive);
    archive(momentum_compensation_.lost, place_compensation_, time_compensation_.lost);
  }

 private:
  TrajectoryPoint<Sys> point_;
  Compensation<AlgebroidVector<G>> momentum_compensation_{AlgebroidVector<G>::Zero()};
  AlgebroidVector<G> place_compensation_ = AlgebroidVector<G>::Zero();
  Compensation<double> time_compensation_{};
};

template <DiscreteSystem Sys>
void CompensatedTrajectory<Sys>::join(const G& groupoid, const StepSolution<Sys>& solution) {
  point_.step = solution.step;
  momentum_compensation_.add(point_.state.momentum, solution.momentum_change);
  ArrowOf<G> reached = groupoid.compose(point_.configuration, solution.step.arrow);
  place_compensation_ = groupoid.correct(reached, AlgebroidVector<G>(place_compensation_ + solution.remainder));
  const ArrowOf<G> projected = groupoid.project(reached);
  point_.configuration = projected;
  const ObjectOf<G> object = groupoid.target(projected);
  point_.state.object = object;
}

}  // namespace lagroid
