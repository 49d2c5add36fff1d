#pragma once
/// A pendulum that is driven, by a torque or by its moving support: the smallest system that depends on time,
///
///     L = m l^2 q'^2 / 2 - U(q, t),    U = -m l (g - a nu^2 cos nu t) cos q - b q cos nu t.
///
///     DrivenPendulum pendulum;
///     pendulum.amplitude = 0.1;
///     pendulum.frequency = 30;  // a nu > sqrt(2 g l): it stands upright

#include <lagroid/core/parameter.hpp>
#include <lagroid/core/quantity.hpp>
#include <lagroid/core/scalars/varied.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/systems/instances.hpp>

#include <cmath>

namespace lagroid {

/// A mass m on a massless rod of length l whose support moves up and down as a cos(nu t), under a torque b cos(nu t): q
/// the angle from the downward vertical. Up to a total time derivative, with p = m l^2 q',
///
///     L = m l^2 q'^2 / 2 - U(q, t),    U = -m l (g - a nu^2 cos nu t) cos q - b q cos nu t,
///
/// discretised with U at the middle of the arrow, in space and time. With a nu > sqrt(2 g l) and a much smaller than l
/// the upright position is stable (Kapitza).
struct DrivenPendulum : System<DrivenPendulum, Pair<1>> {
  double h = 0.01;
  double time = 0;       ///< at the start of the next arrow, s
  double bob_mass = 1;   ///< m, kg
  double length = 1;     ///< l, m
  double gravity = 1;    ///< g, m/s^2
  double frequency = 1;  ///< nu, rad/s
  double torque = 0;     ///< b, N m
  double amplitude = 0;  ///< a, m

  static auto parameters() {
    return std::tuple(parameter("mass", &DrivenPendulum::bob_mass, "kg", "of the bob", positive),
                      parameter("length", &DrivenPendulum::length, "m", "of the rod", positive),
                      parameter("gravity", &DrivenPendulum::gravity, "m/s^2", "acceleration"),
                      parameter("frequency", &DrivenPendulum::frequency, "rad/s", "of the drive"),
                      parameter("torque", &DrivenPendulum::torque, "N m", "amplitude of the torque"),
                      parameter("amplitude", &DrivenPendulum::amplitude, "m", "of the support's motion up and down"));
  }
  std::optional<Refusal> refused() const {
    return refuse_lost_digits({"length", "mass"}, "the inertia m l^2", bob_mass * length * length);
  }

  template <class S = double> ParameterScalar<S> mass() const {
    return varied<S>(bob_mass) * varied<S>(length) * varied<S>(length);
  }

  template <class S, class T> S potential(const S& q, const T& t) const {
    using std::cos;
    const auto nu = varied<S>(frequency);
    const auto drive = cos(t * nu);
    return cos(q) * (drive * (varied<S>(amplitude) * nu * nu) - varied<S>(gravity)) *
               (varied<S>(bob_mass) * varied<S>(length)) -
           q * (drive * varied<S>(torque));
  }

  template <class S, class T> S lagrangian(const PairArrow<S, 1>& g, const T& start, const T& step) const {
    const S dq = g.target(0) - g.source(0);
    const S middle = (g.source(0) + g.target(0)) * 0.5;
    return dq * dq * (0.5 * mass<S>() / step) - potential(middle, T(start + step * 0.5)) * step;
  }
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return lagrangian(g, time, h); }

  /// p^2 / (2 m l^2) + U(q, t): changes, by what the drive does.
  double energy(const State<Pair<1>>& s, double t) const {
    return s.momentum(0) * s.momentum(0) / (2 * mass()) + potential(s.object(0), t);
  }

  /// The continuous solution a time t after `time`.
  State<Pair<1>> reference(const State<Pair<1>>& start, double t) const;

  std::vector<Quantity<DrivenPendulum>> quantities() const { return {}; }
};

LAGROID_STEPS(extern template, DrivenPendulum);
LAGROID_STEP_SOLVERS(extern template, DrivenPendulum);

}  // namespace lagroid
