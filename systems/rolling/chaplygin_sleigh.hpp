#pragma once
/// The Chaplygin sleigh, a body that slides on the plane on a blade: nonholonomic, on SE(2), with xi = (w, v1, v2),
///
///     l = (m v1^2 + m (v2 + a w)^2 + I w^2) / 2,    v2 = 0.
///
/// Energy is conserved and yet nearly all motions approach a straight one: phase volume is not kept.
///
///     const ChaplyginSleigh sleigh;
///     const State<SE2> start = sleigh.sliding(1, 0.5);  // w, v1
///     const double energy = sleigh.energy(start);
///
/// Requires positive mass and inertia, and starts that keep v2 = 0, which `sliding` makes. (Bloch, Nonholonomic
/// Mechanics and Control, chapter 1.)

#include <lagroid/core/capabilities/balance.hpp>
#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/systems/control/group_control.hpp>
#include <lagroid/systems/instances.hpp>

#include <array>
#include <string_view>
#include <vector>

namespace lagroid {

/// A rigid body that slides on the plane on a blade, which moves along its edge only. The centre of mass lies at the
/// distance a ahead of the blade (Chaplygin 1911; Bloch, Nonholonomic Mechanics and Control, chapter 1). On SE(2),
/// with xi = (w, v1, v2) the velocity of the blade in the body's frame, v1 along its edge,
///
///     l = (m v1^2 + m (v2 + a w)^2 + I w^2) / 2,    v2 = 0,
///     m v1' = m a w^2,    (I + m a^2) w' = -m a w v1.
///
/// The energy is conserved; momentum is not: with a > 0 every motion but one approaches a straight one, blade behind.
/// Momentum (M, p1, p2) = ((I + m a^2) w + m a v2, m v1, m (v2 + a w)).
struct ChaplyginSleigh : GroupControl<ChaplyginSleigh, SE2, /*constraints*/ 1> {
  static constexpr auto principle = Principle::nonholonomic;

  double mass = 1;     ///< m, kg
  double inertia = 1;  ///< I, about the centre of mass, kg m^2
  double offset = 1;   ///< a, m

  static auto parameters() {
    return std::tuple(parameter("mass", &ChaplyginSleigh::mass, "kg", "of the body", positive),
                      parameter("inertia", &ChaplyginSleigh::inertia, "kg m^2", "about its centre of mass", positive),
                      parameter("offset", &ChaplyginSleigh::offset, "m", "from the blade ahead to the centre of mass"),
                      map_parameter());
  }

  template <class S> S l(const Vector<S, 3>& xi) const {
    const S across = xi(2) + xi(0) * varied<S>(offset);
    const auto m = varied<S>(mass);
    return (xi(1) * xi(1) * m + across * across * m + xi(0) * xi(0) * varied<S>(inertia)) * 0.5;
  }
  template <class S> Vector<S, 1> psi(const Vector<S, 3>& xi) const { return Vector<S, 1>(xi(2)); }

  /// I + m a^2.
  double blade_inertia() const { return inertia + mass * offset * offset; }
  /// The state of a sleigh that turns at the rate w and moves ahead at v1.
  State<SE2> sliding(double turning, double speed) const {
    State<SE2> s;
    s.momentum = momentum_of(s.object, Vector<double, 2>(turning, speed));
    return s;
  }
  static constexpr std::array<std::string_view, 2> velocity_names{"w", "v1"};
  /// Of (w, v1).
  template <class S>
  Vector<S, 3> momentum_of(const ObjectOf<SE2, S>& /*the one there is*/, const Vector<S, 2>& v) const {
    const auto m = varied<S>(mass);
    const auto a = varied<S>(offset);
    return {v(0) * (varied<S>(inertia) + m * a * a), v(1) * m, v(0) * (m * a)};
  }
  /// (w, v1) of a state that keeps the constraint.
  Vector<double, 2> velocities(const State<SE2>& s) const {
    return {s.momentum(0) / blade_inertia(), s.momentum(1) / mass};
  }

  /// The displacement of a step at constant velocity.
  Step<ChaplyginSleigh> first_guess(const State<SE2>& s) const {
    const Vector<double, 2> v = velocities(s);
    return {arrow(Vector<double, 3>(v(0), v(1), 0)), Multipliers::Zero()};
  }

  /// (I + m a^2) w^2 / 2 + m v1^2 / 2.
  double energy(const State<SE2>& s) const {
    const Vector<double, 2> v = velocities(s);
    return 0.5 * (blade_inertia() * v(0) * v(0) + mass * v(1) * v(1));
  }

  /// (w, v1) after time t in closed form, for a > 0: with c^2 = 2 E, B = I + m a^2 and r = a c sqrt(m) / B,
  ///     v1 = c tanh(r t + s) / sqrt(m),    w = +-c sech(r t + s) / sqrt(B),    s fixed by the start.
  Vector<double, 2> closed_form(const State<SE2>& start, double t) const;
  /// The continuous solution after time t. Returns the state and updates the pose.
  State<SE2> reference(const State<SE2>& start, Matrix<double, 3, 3>& pose, double t) const;

  /// Turning about the blade, and moving ahead: sections that span D.
  std::vector<Symmetry<ChaplyginSleigh>> sections() const;
  std::vector<Quantity<ChaplyginSleigh>> quantities() const;
  static std::vector<ObservedName> observed_names() {
    return {{"E", "energy"}, {"velocities", "w"}, {"velocities", "v1"}};
  }
  template <class S> Vector<S, 3> observed(const State<SE2, S>& s, const Matrix<S, 3, 3>& /*pose*/) const {
    const auto m = varied<S>(mass);
    const auto a = varied<S>(offset);
    const S w = s.momentum(0) / (varied<S>(inertia) + m * a * a);
    const S v1 = s.momentum(1) / m;
    return {(s.momentum(0) * w + s.momentum(1) * v1) * 0.5, w, v1};
  }
};

LAGROID_STEPS(extern template, ChaplyginSleigh);
LAGROID_STEP_SOLVERS(extern template, ChaplyginSleigh);

}  // namespace lagroid
