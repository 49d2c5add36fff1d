#include "../../scenes/any_system.hpp"

#include <lagroid/systems/control/unicycle.hpp>

#include <numbers>

namespace lagroid {
LAGROID_VARIED_STEPS(extern template, Unicycle);
}

namespace lagroid::app {

namespace {

void dress(Presentation<Unicycle>& p, const Unicycle& system) {
  p.position_unit = "m for x, y; rad for the heading";
  p.momentum = {"M", "p1", "p2"};
  p.momentum_unit = "1/s for M; 1/(m s) for p";
  p.multipliers = {"lambda1", "lambda2"};
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
}

constexpr const char* name = "unicycle";

/// Refuses an end that is farther than it rolls.
BoundaryScene<Unicycle> read_ends_in_reach(const Section& scene) {
  const BoundaryScene<Unicycle> ends = read_ends<Unicycle>(scene);
  const auto& [problem, steps] = ends.stage;
  const double distance = problem.boundary.topRightCorner<2, 1>().norm();
  const double length = problem.system.speed * problem.system.h * double(steps);
  if (distance > length)
    scene.section_or_empty("boundary")
        .section_or_empty("end")
        .fail("position",
              fmt::format("lies {:.6g} m from the start; in the time given it rolls {:.6g} m", distance, length));
  return ends;
}

PreparedScene<Unicycle> read(const Section& scene, const RunContext& context) {
  return read_any_system<Unicycle>(scene, context, name, dress, read_ends_in_reach);
}

}  // namespace

const SystemModule& unicycle_module() {
  static const ModuleOf<Unicycle> module(name, "steering at constant speed: planar elastica on SE(2)", read,
                                         [] { return keys_of<Unicycle>(name, dress); });
  return module;
}

}  // namespace lagroid::app
