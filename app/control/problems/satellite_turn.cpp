#include <lagroid/systems/control/flows/satellite_turn.hpp>

#include "../problem_of.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& satellite_turn_problem() {
  static const ControlProblemOf<SatelliteTurn> problem(
      "satellite_turn", "a satellite turned by torques, its boresight kept off a direction", {"cone"});
  return problem;
}

}  // namespace lagroid::app
