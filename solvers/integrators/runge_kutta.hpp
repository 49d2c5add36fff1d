#pragma once
/// The classical Runge-Kutta method of order four for the rates (q', mu') of a system, in coordinates. It keeps no
/// momentum, no constraint and no structure: it is there to compare with.
///
///     RungeKuttaIntegrator<Kepler> orbit(Kepler{}, {{1, 0}, {0, 1}}, Pair<2>::unit(Vector<double, 2>(1, 0)));
///     const StepReport report = orbit.advance();
///
/// Requires a system with `rates` and a step `h`, and a configuration that ends at the initial object
/// (std::invalid_argument). Status: `not_finite`, which leaves everything as it was. (Kutta 1901; Hairer, Norsett,
/// Wanner I, table II.1.2.)

#include <lagroid/core/capabilities/rates_over.hpp>
#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/quantity.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <utility>

namespace lagroid {

namespace detail {

/// A step of length h from an arrow's coordinates and a momentum, over any scalar that the rates take.
template <class Sys, class S> class RungeKuttaStep {
 public:
  using G = typename Sys::GroupoidType;
  using Coordinates = Vector<S, G::arrow_coordinate_count()>;
  struct Point {
    Coordinates arrow;
    AlgebroidVector<G, S> momentum;
  };

  /// Refers to the system.
  explicit RungeKuttaStep(const Sys& system) : system_(system) {}

  Point from(const Point& start, double h) const {
    const auto at = [&](const Point& k, double t) {
      return slope({start.arrow + k.arrow * t, start.momentum + k.momentum * t});
    };
    const Point k1 = slope(start);
    const Point k2 = at(k1, h / 2);
    const Point k3 = at(k2, h / 2);
    const Point k4 = at(k3, h);
    const double sixth = h / 6;
    return {start.arrow + (k1.arrow + (k2.arrow + k3.arrow) * 2.0 + k4.arrow) * sixth,
            start.momentum + (k1.momentum + (k2.momentum + k3.momentum) * 2.0 + k4.momentum) * sixth};
  }

 private:
  Point slope(const Point& at) const {
    const G& groupoid = system_.groupoid;
    const ArrowOf<G, S> g = groupoid.template arrow_at<S>(at.arrow);
    const auto rates = system_.rates(State<G, S>{groupoid.target(g), at.momentum});
    return {groupoid.left_invariant(g, rates.velocity), rates.momentum};
  }

  const Sys& system_;
};

}  // namespace detail

/// Integrates the rates of a system by Kutta's method of order 4 (Kutta 1901; Hairer, Norsett, Wanner I, table II.1.2)
/// in the coordinates of arrows and momenta. Nothing brings the arrow back onto the groupoid, nor an object back to its
/// constraints, and nothing is carried: the numbers drift off as those of any such program do. No allocation.
template <HasRates Sys> class RungeKuttaIntegrator {
 public:
  using G = typename Sys::GroupoidType;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint).
  RungeKuttaIntegrator(Sys system, const State<G>& initial, const ArrowOf<G>& configuration)
      : system_(std::move(system)) {
    point_.state = initial;
    system_.groupoid.require_initial_end(configuration, initial.object);
    point_.configuration = configuration;
    point_.step = {system_.groupoid.unit(initial.object), Sys::Multipliers::Zero()};
  }

  const TrajectoryPoint<Sys>& point() const { return point_; }
  MethodTraits traits() const { return {"Runge-Kutta", 4, false, false, true, 4}; }

  /// `converged`, or `not_finite`, which leaves everything as it was.
  StepReport advance();
  /// Goes to a point, from which the next step is a share of what it was.
  void begin_cut(const TrajectoryPoint<Sys>& from, double share) {
    system_.h *= share;
    point_ = from;
  }
  /// Goes on from a point of the same index and time, which no step of its own led to.
  void go_on_from(const TrajectoryPoint<Sys>& point) { point_ = point; }
  /// Visits all that the next step goes on from.
  void serialize(NumberArchive& archive) { point_.serialize(system_.groupoid, archive); }

 private:
  Sys system_;
  TrajectoryPoint<Sys> point_;
};

template <HasRates Sys> StepReport RungeKuttaIntegrator<Sys>::advance() {
  const G& groupoid = system_.groupoid;
  const double h = system_.h;
  const auto reached = detail::RungeKuttaStep<Sys, double>(system_).from(
      {groupoid.coordinates_of_arrow(point_.configuration), point_.state.momentum}, h);
  StepReport report;
  report.status = SolveStatus::not_finite;
  if (!reached.arrow.allFinite() || !reached.momentum.allFinite()) return report;
  report.status = SolveStatus::converged;
  const ArrowOf<G> g = groupoid.template arrow_at<double>(reached.arrow);
  point_.step.arrow = groupoid.multiply(groupoid.inverse(point_.configuration), g);
  point_.configuration = g;
  point_.state = {groupoid.target(g), reached.momentum};
  point_.time = double(++point_.index) * h;
  point_.step_size = h;
  return report;
}

}  // namespace lagroid
