#include <lagroid/systems/control/attitude_control.hpp>

namespace lagroid {

bool AttitudeControl::is_axial() const {
  using Square = Matrix<double, 3, 3>;
  const Square across = Square::Identity() - forbidden * forbidden.transpose();
  const Square weight = across * weights.asDiagonal() * across;
  return (weight - 0.5 * weight.trace() * across).norm() <= 1e-14 * weights.norm();
}

std::vector<Symmetry<AttitudeControl>> AttitudeControl::symmetries() const {
  if (!is_axial()) return {};
  return {{"axial momentum M.n", [n = forbidden](const Vector<double, 0>&) { return n; }}};
}

std::vector<Quantity<AttitudeControl>> AttitudeControl::quantities() const {
  auto all = GroupControl::quantities();
  for (const auto& symmetry : symmetries()) all.push_back(symmetry.quantity());
  return all;
}

}  // namespace lagroid
