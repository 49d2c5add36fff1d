#include <lagroid/systems/attitude_control.hpp>

namespace lagroid {

LAGROID_STEPS(template, AttitudeControl);

bool AttitudeControl::is_axial() const {
  for (int i = 0; i < 3; ++i)
    if (forbidden(i) != 0 && weights((i + 1) % 3) != weights((i + 2) % 3)) return false;
  return true;
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
