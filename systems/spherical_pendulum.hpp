#pragma once
/// The spherical pendulum, as R^3 with an object constraint.

#include <lagroid/core/noether.hpp>
#include <lagroid/systems/instances.hpp>
#include <lagroid/systems/mechanical.hpp>

namespace lagroid {

/// A mass m on a rod of length l, q in R^3 with C(q) = (|q|^2 - l^2) / 2 = 0, U = m g q3 (e3 points up).
/// Momentum p = m q'. With the trapezoid this is SHAKE, with projected momenta RATTLE.
struct SphericalPendulum : MechanicalSystem<SphericalPendulum, 3, /*object constraints*/ 1> {
  double bob_mass = 1;  ///< m, kg
  double length = 1;    ///< l, m
  double gravity = 1;   ///< g, m/s^2

  SphericalPendulum() { quadrature = Quadrature::trapezoid; }

  double mass() const { return bob_mass; }
  template <class S> S potential(const Vector<S, 3>& q) const { return q(2) * (bob_mass * gravity); }
  template <class S> Vector<S, 1> object_constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>((q.squaredNorm() - length * length) * 0.5);
  }

  /// The continuous solution after time t: p' = -m g e3 + s q with s such that the rod keeps its length.
  State<Pair<3>> reference(const State<Pair<3>>& start, double t) const;

  /// Of sigma = (w0^2 + |w|^2)^(-1/2), w = p / (m l) the angular velocity, w0^2 = |g| / l.
  double time_scale_rate(const State<Pair<3>>& s) const {
    const double unit = bob_mass * length;
    return bob_mass * gravity * s.momentum(2) / (std::abs(gravity) / length * unit * unit + s.momentum.squaredNorm());
  }

  /// Rotation about the vertical.
  std::vector<Symmetry<SphericalPendulum>> symmetries() const {
    return {
        {"vertical angular momentum", [](const Vector<double, 3>& q) { return Vector<double, 3>(-q(1), q(0), 0); }}};
  }
  std::vector<Quantity<SphericalPendulum>> quantities() const {
    // Near the vertical the bob moves little: its momentum is rounded relative to the rod all the same.
    return {energy_quantity(), symmetries()[0].quantity([](const TrajectoryPoint<SphericalPendulum>& p) {
              return p.state.object.norm() * p.state.momentum.norm();
            })};
  }
};

LAGROID_STEPS(extern template, SphericalPendulum);
LAGROID_SOLVERS(extern template, SphericalPendulum);

}  // namespace lagroid
