#pragma once
/// The planar pendulum: q the angle from the downward vertical, p = m l^2 q',
///
///     L = m l^2 q'^2 / 2 + m g l cos q.
///
/// The smallest system with all that the library knows of one.
///
///     Pendulum pendulum;
///     pendulum.length = 0.5;
///     const double energy = pendulum.energy({Vector<double, 1>(0.1), Vector<double, 1>(0.0)});
///
/// Requires a positive length and mass; `refused` rejects those whose inertia m l^2 has lost its digits.

#include <lagroid/systems/instances.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <cmath>

namespace lagroid {

/// A mass m on a massless rod of length l: q the angle from the downward vertical, in radians; U = -m g l cos q.
/// Momentum p = m l^2 q'.
struct Pendulum : MechanicalSystem<Pendulum, 1> {
  double bob_mass = 1;  ///< m, kg
  double length = 1;    ///< l, m
  double gravity = 1;   ///< g, m/s^2

  static auto parameters() {
    return std::tuple(parameter("mass", &Pendulum::bob_mass, "kg", "of the bob", positive),
                      parameter("length", &Pendulum::length, "m", "of the rod", positive),
                      parameter("gravity", &Pendulum::gravity, "m/s^2", "acceleration"), quadrature_parameter());
  }
  std::optional<Refusal> refused() const {
    return refuse_lost_digits({"length", "mass"}, "the inertia m l^2", bob_mass * length * length);
  }

  /// The inertia m l^2.
  template <class S = double> ParameterScalar<S> mass() const {
    return varied<S>(bob_mass) * varied<S>(length) * varied<S>(length);
  }
  template <class S> S potential(const Vector<S, 1>& q) const {
    using std::cos;
    return cos(q(0)) * (-varied<S>(bob_mass) * varied<S>(gravity) * varied<S>(length));
  }

  template <class S> Vector<S, 1> gradient(const Vector<S, 1>& q) const {
    using std::sin;
    return Vector<S, 1>(sin(q(0)) * (varied<S>(bob_mass) * varied<S>(gravity) * varied<S>(length)));
  }

  /// Of sigma = (w0^2 + w^2)^(-1/2), w = q', w0^2 = |g| / l.
  template <class S> S time_scale_rate(const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    using std::sin;
    const S w = p(0) / mass<S>();
    const ParameterScalar<S> square = varied<S>(gravity) / varied<S>(length);
    return w * square * sin(q(0)) / (square * (gravity < 0 ? -1.0 : 1.0) + w * w);
  }
  double time_scale_rate(const State<Pair<1>>& s) const { return time_scale_rate(s.object, s.momentum); }

  std::vector<Quantity<Pendulum>> quantities() const { return {energy_quantity()}; }
};

LAGROID_STEPS(extern template, Pendulum);
LAGROID_SOLVERS(extern template, Pendulum);

}  // namespace lagroid
