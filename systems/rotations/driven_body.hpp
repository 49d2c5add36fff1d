#pragma once
/// A rigid body under thrust and drag, M' = M x w + T - c w, with the discrete forces
///
///     f- = f+ = (h T - c tau^{-1}(g)) / 2.
///
/// A forced system on a group, whose ledger balances energy against work.
///
///     DrivenBody body;
///     body.torque = {0, 0, 0.1};
///     body.drag = 0.05;
///
/// Requires positive principal moments and a drag that is not negative.

#include <lagroid/core/capabilities/balance.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

namespace lagroid {

/// The rigid body with a torque T fixed in it (a thruster) and the drag -c w: M' = M x w + T - c w,
/// dE/dt = T.w - c |w|^2. On an arrow the impulse h T - c tau^{-1}(g) acts by halves on either end.
struct DrivenBody : RigidBody {
  double drag = 0.1;                  ///< c, N m s
  Vector<double, 3> torque{0, 0, 0};  ///< T, N m, in the body

  static auto parameters() {
    return std::tuple_cat(
        RigidBody::parameters(),
        std::tuple(parameter("torque", &DrivenBody::torque, "N m", "of a thruster, fixed in the body"),
                   parameter("drag", &DrivenBody::drag, "N m s", "torque over angular velocity", nonnegative)));
  }

  template <class S, class T> Forces<S, 3> forces(const Matrix<S, 3, 3>& g, const T& step) const {
    const Vector<S, 3> turn = SO3::retract_inverse(rotation, g);
    const auto& thrust = varied<S>(torque);
    Vector<S, 3> half = turn * (-0.5 * varied<S>(drag));
    for (int i = 0; i < 3; ++i) half(i) += step * (0.5 * thrust(i));
    return {half, half};
  }
  template <class S> Forces<S, 3> forces(const Matrix<S, 3, 3>& g) const { return forces(g, h); }

  /// The continuous solution after time t. Returns M and updates `attitude`.
  State<SO3> reference(const State<SO3>& start, Matrix<double, 3, 3>& attitude, double t) const;

  /// The rotation by h I^{-1} M.
  Step<DrivenBody> first_guess(const State<SO3>& s) const { return {RigidBody::first_guess(s).arrow, {}}; }

  std::vector<Quantity<DrivenBody>> quantities() const { return {energy_balance(*this)}; }
};

LAGROID_STEPS(extern template, DrivenBody);
LAGROID_STEP_SOLVERS(extern template, DrivenBody);

}  // namespace lagroid
