#include "../reading/boundary_value.hpp"
#include "group_map.hpp"
#include "pose.hpp"
#include "readers.hpp"

#include <numbers>

namespace lagroid::app {

namespace {

Unicycle read_system(const Section& scene) {
  const Section parameters = scene.section_or_empty("parameters");
  Unicycle system;
  system.speed = parameters.number_or("speed", 1, positive);
  system.map = read_group_map(parameters, "map");
  system.h = read_time(scene).step;
  return system;
}

BoundaryScene<Unicycle> read_boundary(const Section& scene) {
  const Section boundary = scene.section("boundary", "start and end");
  const Matrix<double, 3, 3> start = read_pose(boundary.section("start", "position"));
  const Matrix<double, 3, 3> end = read_pose(boundary.section("end", "position"));
  const Unicycle system = read_system(scene);
  const long steps = read_time(scene).steps;
  const double distance = (end - start).topRightCorner<2, 1>().norm();
  const double length = system.speed * system.h * double(steps);
  if (distance > length)
    boundary.section("end", "position")
        .fail("position",
              fmt::format("lies {:.6g} m from the start; in the time given it rolls {:.6g} m", distance, length));
  return {{{system, SE2::project(SE2::multiply(SE2::inverse(start), end))}, std::size_t(steps)}, start};
}

}  // namespace

Task<Unicycle> read_unicycle(const Section& scene, const RunContext& context) {
  Presentation<Unicycle> p;
  p.name = "unicycle";
  p.position = {"x", "y", "heading"};
  p.position_unit = "m for x, y; rad for the heading";
  p.momentum = {"M", "p1", "p2"};
  p.momentum_unit = "1/s for M; 1/(m s) for p";
  p.multipliers = {"lambda1", "lambda2"};
  p.position_of = [](const TrajectoryPoint<Unicycle>& point) { return coordinates_of_pose(point.configuration); };
  const Unicycle system = read_system(scene);
  p.extras = {{{"controls", {"w"}, "rad/s", "turning rate over the arrow", true, {}},
               [system](const TrajectoryPoint<Unicycle>& point, double* out) {
                 *out = system.velocity(point.step.arrow, point.step_size)(0);
               }}};
  p.conventions = {{"position", "pose A_k = A_{k-1} g_k: x, y and the angle from the x axis to where it rolls"},
                   {"momentum", "body momentum: M = w and the force p ahead and to the left"},
                   {"multipliers", "sign of L + <lambda, phi>, phi = h (v1 - speed, v2)"}};
  Shape wheel = on_the_plane({"disk", {0.1, 0.02}}, 0.1);
  wheel.turns.push_back({{1, 0, 0}, -0.5 * std::numbers::pi});
  wheel.trail = true;
  p.shapes = {wheel};
  p.panels = {{"path", "x", "y", "x", {"y"}, true},
              {"heading", "t", "angle, rad", "t", {"heading"}},
              {"turning rate", "t", "w", "t", {"w"}},
              {"energy error", "t", "|H - H_0|", "t", {"drift energy"}},
              {"spatial momentum error", "t", "deviation", "t", {"drift spatial momentum"}}};

  if (is_boundary_value(scene, "position and momentum"))
    return boundary_value<Unicycle>(scene, context, p, read_boundary);
  const Section initial = scene.section("initial", "position and momentum");
  State<SE2> state;
  state.momentum = Eigen::Map<const Vector<double, 3>>(initial.numbers("momentum", 3, "M, p1, p2").data());
  const Matrix<double, 3, 3> pose = read_pose(initial);
  return simulation(scene, context, system, p, state, pose);
}

}  // namespace lagroid::app
