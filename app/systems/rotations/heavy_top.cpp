#include "../../scenes/any_system.hpp"
#include "rotating.hpp"

#include <lagroid/systems/rotations/heavy_top.hpp>

namespace lagroid {
LAGROID_VARIED_STEPS(extern template, HeavyTop);
}

namespace lagroid::app {

/// A node is an attitude: the arrow from the vertical in space to that seen from the body.
template <> struct ArrowFormat<HeavyTop::GroupoidType> {
  using Arrow = ArrowOf<HeavyTop::GroupoidType>;
  static constexpr std::string_view key = "attitude";
  HeavyTop::GroupoidType groupoid;

  static auto declared(std::string_view name) { return ArrowFormat<SO3>::declared(name); }
  static Arrow read(const Section& section, std::string_view name) {
    return {ArrowFormat<SO3>::read(section, name), Vector<double, 3>(0, 0, 1)};
  }
  Arrow between(const Arrow& start, const Arrow& end) const {
    return groupoid.project(groupoid.multiply(groupoid.inverse(start), end));
  }
  static std::vector<std::string> labels(std::string_view) { return {"v1", "v2", "v3"}; }
  static std::vector<double> coordinates(const Arrow&, const Vector<double, 3>& v) { return {v.data(), v.data() + 3}; }
  static std::optional<std::array<double, 4>> attitude(const Arrow& a) { return quaternion_of(a.element); }
};

namespace {

/// A Lagrange top as a cone, another as a box with its centre of mass away from the fixed point; and a point of it.
std::vector<Shape> shapes_of(const HeavyTop& system) {
  const Vector<double, 3> arm = system.weight.norm() > 0 ? system.weight.normalized() : Vector<double, 3>(0, 0, 0);
  Shape body{"cone", {1, 0.4}};
  if (!system.is_lagrange()) {
    body = box_of({system.inertia(0), system.inertia(1), system.inertia(2)});
    body.offset = {arm(0), arm(1), arm(2)};
  }
  body.attitude = attitude_columns;
  Shape point{"sphere", {0.04}};
  point.attitude = attitude_columns;
  point.offset = {1.2 * arm(0), 1.2 * arm(1), 1.2 * arm(2)};
  point.trail = true;
  return {body, point};
}

void dress(Presentation<HeavyTop>& p, const HeavyTop& system) {
  p.position_unit = "1";
  p.momentum = {"M1", "M2", "M3"};
  p.momentum_unit = "kg m^2/s";
  p.conventions = {{"attitude", "A_k = A_{k-1} g_k carries body to space"},
                   {"position", "the upward vertical seen from the body, A^T e3"},
                   {"momentum", "body angular momentum M"}};
  p.panels = turning_panels();
  p.panels.insert(p.panels.begin() + 1, {"vertical seen from the body", "t", "v", "t", {"v1", "v2", "v3"}});
  p.panels.push_back({"energy error", "t", "|H - H_0|", "t", {"drift energy"}});
  p.panels.push_back({"vertical momentum error", "t", "|M.v - (M.v)_0|", "t", {"drift vertical momentum M.v"}});
  p.extras = {angular_velocity_of<HeavyTop>(system.inertia)};
  p.shapes = shapes_of(system);
}

}  // namespace

const SystemModule& heavy_top_module() {
  static const auto module =
      any_module<HeavyTop>("heavy_top", "rigid body with a fixed point under gravity, SO(3) acting on S^2", dress);
  return module;
}

}  // namespace lagroid::app
