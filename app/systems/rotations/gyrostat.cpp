#include "../../scenes/any_system.hpp"
#include "rotating.hpp"

#include <lagroid/systems/rotations/gyrostat.hpp>

namespace lagroid {
LAGROID_VARIED_STEPS(extern template, Gyrostat);
}

namespace lagroid::app {

namespace {

using Point = TrajectoryPoint<Gyrostat>;

void dress(Presentation<Gyrostat>& p, const Gyrostat& system) {
  p.position_unit = "rad, of the rotors against the body, in (-pi, pi]";
  p.momentum = {"M1", "M2", "M3", "j1", "j2", "j3"};
  p.momentum_unit = "kg m^2/s";
  p.extras = {{{"rates",
                {"w1", "w2", "w3", "t1", "t2", "t3"},
                "rad/s",
                "of the body, in its frame; of the rotors against it",
                false,
                {}},
               [system](const Point& point, double* out) {
                 Eigen::Map<Vector<double, 6>> rates(out);
                 rates = system.velocity(point.state.momentum);
               }}};
  p.conventions = {{"attitude", "A_k = A_{k-1} g_k carries body to space"},
                   {"momentum", "body angular momentum M, rotors' momenta j about their axes"}};
  p.panels = turning_panels();
  p.panels.push_back({"rates of the rotors", "t", "t", "t", {"t1", "t2", "t3"}});
  p.panels.push_back({"energy error", "t", "|H - H_0|", "t", {"drift energy"}});
  p.panels.push_back({"spatial momentum error", "t", "|A M - (A M)_0|", "t", {"drift spatial momentum A M"}});
  p.shapes = {box_of({system.inertia(0), system.inertia(1), system.inertia(2)})};
}

}  // namespace

const SystemModule& gyrostat_module() {
  static const auto module = any_module<Gyrostat>("gyrostat", "rigid body with three rotors on its axes", dress);
  return module;
}

}  // namespace lagroid::app
