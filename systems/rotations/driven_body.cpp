#include <lagroid/systems/reference.hpp>
#include <lagroid/systems/rotations/driven_body.hpp>

namespace lagroid {

State<SO3> DrivenBody::reference(const State<SO3>& start, Matrix<double, 3, 3>& attitude, double t) const {
  const Torque driven = [&](const auto& w, const auto&) { return Vector<double, 3>(torque - drag * w); };
  return {{}, reference_turn(inertia, driven, start.momentum, attitude, t)};
}

}  // namespace lagroid
