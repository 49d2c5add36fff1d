#include "scene_picture.hpp"

#include "../scenes/attitude.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lagroid::app {

using multibody::Vec;

std::string column(const std::string& body, std::string_view what) { return fmt::format("{}.{}", body, what); }

std::vector<std::string> columns(const std::string& body, std::initializer_list<std::string_view> what) {
  std::vector<std::string> out;
  for (const auto& w : what) out.push_back(column(body, w));
  return out;
}

std::vector<std::string> attitude_of(const std::string& body) { return columns(body, {"A_w", "A_x", "A_y", "A_z"}); }

std::string end_column(std::size_t line, const char* end) { return fmt::format("line{}.{}", line, end); }

namespace {

bool turns_in_space(const NamedBody& b) { return b.body.attitude.index >= 0; }
bool moves_about(const NamedBody& b) { return b.linear >= 0; }
bool moves_in_the_plane(const NamedBody& b) { return moves_about(b) && b.planar; }

/// The last of the bodies that are recorded and of the kind that is asked for, so few that their curves can be told
/// apart.
std::vector<const NamedBody*> last_few(const SceneBodies& bodies, const std::set<std::string>& chosen,
                                       bool (*is_wanted)(const NamedBody&), std::ptrdiff_t most) {
  std::vector<const NamedBody*> few;
  for (const auto& b : bodies.bodies)
    if (is_wanted(b) && (chosen.empty() || chosen.contains(b.name))) few.push_back(&b);
  if (std::ssize(few) > most) few.erase(few.begin(), few.end() - most);
  return few;
}

}  // namespace

std::vector<Shape> shapes_of(const SceneBodies& bodies, const std::set<std::string>& chosen) {
  std::vector<Shape> out = bodies.scenery;
  const double extent = bodies.extent > 0 ? bodies.extent : 1;
  double heaviest = 0;
  for (const auto& b : bodies.bodies) heaviest = std::max(heaviest, b.mass);
  const auto seen = [&](const NamedBody& b) { return chosen.empty() || chosen.contains(b.name); };
  const auto at = [](const std::string& name) -> std::vector<Coordinate> {
    return {column(name, "x"), column(name, "y"), column(name, "z")};
  };
  for (const auto& b : bodies.bodies) {
    if (!seen(b)) continue;
    Shape shape;
    if (b.radius > 0) {
      shape = {"sphere", {b.radius}};
      shape.attitude = attitude_of(b.name);
    } else if (b.body.attitude.index >= 0) {
      const Vec& c = b.to_centre;
      const Vec moments = b.inertia - b.mass * (Vec::Constant(c.squaredNorm()) - c.cwiseAbs2());
      const bool box = b.mass > 0 && 2 * moments.maxCoeff() < moments.sum();
      shape = box ? box_of_mass(b.mass, {moments(0), moments(1), moments(2)})
                  : box_of({b.inertia(0), b.inertia(1), b.inertia(2)});
      shape.attitude = attitude_of(b.name);
      shape.offset = {c(0), c(1), c(2)};
    } else if (b.planar) {
      const double side = std::sqrt(12 * b.inertia(2) / b.mass);
      shape = {"box", {side, 0.1 * side, 0.1 * side}};
      shape.turns = {{{0, 0, 1}, column(b.name, "angle")}};
    } else {
      shape = {"sphere", {0.03 * extent * std::cbrt(b.mass / heaviest)}};
    }
    shape.position = at(b.name);
    shape.trail = bodies.bodies.size() <= 12 || &b == &bodies.bodies.back();
    out.push_back(shape);
  }
  for (std::size_t k = 0; k < bodies.lines.size(); ++k) {
    const auto& line = bodies.lines[k];
    const auto end = [&](const Attachment& e, const char* name) -> std::vector<Coordinate> {
      if (line.switched_by != 0 && &e == &line.to) return at(end_column(k, name));
      if (!e.body && !e.moved) return {e.place(0), e.place(1), e.place(2)};
      return at(e.body && e.arm.isZero(0) ? e.body->name : end_column(k, name));
    };
    if ((line.from.body && !seen(*line.from.body)) || (line.to.body && !seen(*line.to.body))) continue;
    Shape rod{"rod", {(line.to.place - line.from.place).norm(), line.width * extent}};
    rod.position = end(line.from, "from");
    rod.to = end(line.to, "to");
    out.push_back(rod);
  }
  return out;
}

std::vector<Panel> panels_of(const SceneBodies& bodies, const std::set<std::string>& chosen) {
  std::vector<Panel> out{{"energy", "t", "energy", "t", {"energy"}}};
  const auto together = [&](const std::vector<const NamedBody*>& few, const std::string& title, const char* what) {
    Panel panel{title, "t", what, "t", {}};
    for (const auto* b : few) panel.curves.push_back(column(b->name, what));
    if (!panel.curves.empty()) out.push_back(panel);
  };
  const auto moving = last_few(bodies, chosen, moves_about, 4);
  const auto planar = last_few(bodies, chosen, moves_in_the_plane, 4);
  together(moving, "positions x", "x");
  together(moving, "positions y", "y");
  if (planar.size() < moving.size()) together(moving, "positions z", "z");
  together(planar, "angles", "angle");
  together(planar, "angular velocities", "w");
  together(planar, "angular momenta about the centres", "L");
  for (const auto* b : last_few(bodies, chosen, turns_in_space, 2)) {
    out.push_back(attitude_panel(attitude_of(b->name), "attitude of " + b->name));
    out.push_back({"angular velocity in " + b->name, "t", "w", "t", columns(b->name, {"w1", "w2", "w3"})});
    out.push_back({"angular momentum in " + b->name, "t", "M", "t", columns(b->name, {"M1", "M2", "M3"})});
    if (moves_about(*b)) out.push_back({"momentum of " + b->name, "t", "p", "t", columns(b->name, {"px", "py", "pz"})});
  }
  out.push_back({"constraints", "t", "residual", "t", {"residual"}});
  return out;
}

}  // namespace lagroid::app
