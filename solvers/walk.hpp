#pragma once
/// The accumulation of steps into a trajectory.

#include <lagroid/core/quantity.hpp>
#include <lagroid/solvers/step_solver.hpp>

#include <stdexcept>
#include <string>

namespace lagroid {

namespace detail {

/// Throws std::invalid_argument unless the arrow ends at the object, to 1e-9 of its size. What is not finite passes:
/// the first step's status tells of it.
template <Groupoid G> void require_end(const G& groupoid, const ArrowOf<G>& configuration, const ObjectOf<G>& object) {
  if constexpr (G::object_coordinate_count() > 0) {
    const auto end = groupoid.coordinates_of_object(groupoid.target(configuration));
    const auto start = groupoid.coordinates_of_object(object);
    if (const double gap = (end - start).norm(); gap > 1e-9 * (1 + start.norm()))
      throw std::invalid_argument("configuration: the initial arrow ends " + std::to_string(gap) +
                                  " away from the initial object; it must end there");
  }
}

}  // namespace detail

/// The state, configuration and time that a sequence of solved steps leads to.
///
/// The momentum is updated by its increment, mu' = mu + (F+ - F-)(g, lambda): equal to F+ at a solution, and free of
/// the solve's residual. Momenta on which the Lagrangian does not depend are then kept to the last bit. Objects,
/// momenta and times are sums with carry: what rounding took so far is given back as soon as it can be stored.
template <DiscreteSystem Sys> class Walk {
 public:
  using G = typename Sys::GroupoidType;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint). Throws
  /// std::invalid_argument where it ends elsewhere.
  Walk(const G& groupoid, const State<G>& initial, const ArrowOf<G>& configuration, double start = 0) {
    detail::require_end(groupoid, configuration, initial.object);
    point_.time = start;
    point_.state = initial;
    point_.configuration = configuration;
    point_.step = {groupoid.unit(initial.object), Sys::Multipliers::Zero()};
  }

  const TrajectoryPoint<Sys>& point() const { return point_; }

  /// Joins an arrow to the walk.
  void join(const G& groupoid, const StepSolution<Sys>& solution);

  /// Ends a step of however many arrows at the next point, `step_size` later.
  void arrive(double step_size) {
    ++point_.index;
    point_.step_size = step_size;
    time_carry_ += step_size;
    const double time = point_.time + time_carry_;
    time_carry_ -= time - point_.time;
    point_.time = time;
  }
  /// The same at a known time, the last arrow's step given.
  void arrive_at(double time, double step_size) {
    ++point_.index;
    point_.step_size = step_size;
    point_.time = time;
  }

  /// Visits all that it goes on from.
  void persist(const G& groupoid, Tape& tape) {
    point_.persist(groupoid, tape);
    tape(momentum_carry_, carry_, time_carry_);
  }

 private:
  TrajectoryPoint<Sys> point_;
  AlgebroidVector<G> momentum_carry_ = AlgebroidVector<G>::Zero();
  AlgebroidVector<G> carry_ = AlgebroidVector<G>::Zero();
  double time_carry_ = 0;
};

template <DiscreteSystem Sys> void Walk<Sys>::join(const G& groupoid, const StepSolution<Sys>& solution) {
  point_.step = solution.step;
  momentum_carry_ += solution.momentum_change;
  const AlgebroidVector<G> momentum = point_.state.momentum + momentum_carry_;
  momentum_carry_ -= momentum - point_.state.momentum;
  point_.state.momentum = momentum;
  ArrowOf<G> reached = groupoid.compose(point_.configuration, solution.step.arrow);
  carry_ = groupoid.nudge(reached, AlgebroidVector<G>(carry_ + solution.remainder));
  const ArrowOf<G> projected = groupoid.project(reached);
  point_.configuration = projected;
  const ObjectOf<G> object = groupoid.target(projected);
  point_.state.object = object;
}

}  // namespace lagroid
