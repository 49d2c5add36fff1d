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

#include <lagroid/core/capabilities/rates.hpp>
#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/quantity.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <utility>

namespace lagroid {

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
  using Coordinates = Vector<double, G::arrow_coordinate_count()>;
  struct Slope {
    Coordinates arrow;
    AlgebroidVector<G> momentum;
  };

  Slope slope(const Coordinates& arrow, const AlgebroidVector<G>& momentum) const {
    const G& groupoid = system_.groupoid;
    const ArrowOf<G> g = groupoid.template arrow_at<double>(arrow);
    const Rates<G> rates = system_.rates({groupoid.target(g), momentum});
    return {groupoid.left_invariant(g, rates.velocity), rates.momentum};
  }

  Sys system_;
  TrajectoryPoint<Sys> point_;
};

template <HasRates Sys> StepReport RungeKuttaIntegrator<Sys>::advance() {
  const G& groupoid = system_.groupoid;
  const double h = system_.h;
  const Coordinates arrow = groupoid.coordinates_of_arrow(point_.configuration);
  const AlgebroidVector<G>& momentum = point_.state.momentum;
  const auto at = [&](const Slope& k, double t) { return slope(arrow + t * k.arrow, momentum + t * k.momentum); };
  const Slope k1 = slope(arrow, momentum);
  const Slope k2 = at(k1, h / 2);
  const Slope k3 = at(k2, h / 2);
  const Slope k4 = at(k3, h);
  const Coordinates reached = arrow + h / 6 * (k1.arrow + 2 * (k2.arrow + k3.arrow) + k4.arrow);
  const AlgebroidVector<G> mu = momentum + h / 6 * (k1.momentum + 2 * (k2.momentum + k3.momentum) + k4.momentum);
  StepReport report;
  report.status = SolveStatus::not_finite;
  if (!reached.allFinite() || !mu.allFinite()) return report;
  report.status = SolveStatus::converged;
  const ArrowOf<G> g = groupoid.template arrow_at<double>(reached);
  point_.step.arrow = groupoid.multiply(groupoid.inverse(point_.configuration), g);
  point_.configuration = g;
  point_.state = {groupoid.target(g), mu};
  point_.time = double(++point_.index) * h;
  point_.step_size = h;
  return report;
}

}  // namespace lagroid
