#include <lagroid/systems/control/flows/satellite_turn.hpp>

#include "../problem_of.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& satellite_turn_problem() {
  static const ControlProblemOf<SatelliteTurn> problem(
      "satellite_turn", "a satellite turned by torques, its boresight kept off a direction", {"cone"},
      [](const SatelliteTurn& satellite) {
        const auto& i = satellite.inertia;
        Shape boresight{"rod", {0.8, 0.01}};
        boresight.attitude = attitude_columns;
        boresight.offset = {0, 0, 0.4};
        return std::vector<Shape>{box_of({i(0), i(1), i(2)}), boresight};
      });
  return problem;
}

}  // namespace lagroid::app
