#include <lagroid/systems/reference.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

namespace lagroid {

State<SO3> RigidBody::reference(const State<SO3>& start, Matrix<double, 3, 3>& attitude, double t) const {
  const Torque none = [](const auto&, const auto&) { return Vector<double, 3>(0, 0, 0); };
  return {{}, reference_turn(inertia, none, start.momentum, attitude, t)};
}

}  // namespace lagroid
