#include <lagroid/run/motion/shape.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid {

Shape box_of(const std::array<double, 3>& inertia) {
  const double sum = inertia[0] + inertia[1] + inertia[2];
  std::array<double, 3> sides{};
  // m a^2 = 6 (I2 + I3 - I1); moments of no body at all are drawn thin.
  for (int i = 0; i < 3; ++i) sides[i] = std::sqrt(std::max(sum - 2 * inertia[i], 1e-3 * sum));
  const double longest = *std::max_element(sides.begin(), sides.end());
  Shape box{"box", {}};
  for (const double side : sides) box.size.push_back(side / longest);
  box.attitude = attitude_columns;
  return box;
}

Shape box_of_mass(double mass, const std::array<double, 3>& inertia) {
  Shape box = box_of(inertia);
  const double sum = inertia[0] + inertia[1] + inertia[2];
  const double longest = std::sqrt(6 * (sum - 2 * *std::min_element(inertia.begin(), inertia.end())) / mass);
  for (double& side : box.size) side *= longest;
  return box;
}

Shape on_the_plane(Shape shape, double height) {
  shape.position = {"x", "y", height};
  shape.turns = {{{0, 0, 1}, "heading"}};
  return shape;
}

Shape turning_plate(double rate) {
  Shape plate{"plate", {}};
  plate.turns = {{{0, 0, 1}, "t", rate}};
  return plate;
}

Shape ball_on_plate(double radius) {
  Shape ball{"sphere", {radius}};
  ball.position = {"x", "y", radius};
  ball.attitude = attitude_columns;
  ball.trail = true;
  return ball;
}

std::vector<Shape> hanging(double length, std::string_view q) {
  const std::vector<Turn> turns{{{0, -1, 0}, std::string(q)}};
  Shape rod{"rod", {length, 0.015 * length}};
  rod.turns = turns;
  rod.offset = {0, 0, -0.5 * length};
  Shape bob{"sphere", {0.08 * length}};
  bob.turns = turns;
  bob.offset = {0, 0, -length};
  bob.trail = true;
  return {rod, bob};
}

}  // namespace lagroid
