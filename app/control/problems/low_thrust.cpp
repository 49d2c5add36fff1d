#include <lagroid/systems/control/flows/low_thrust.hpp>

#include "../problem_of.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& low_thrust_problem() {
  static const ControlProblemOf<LowThrust> problem("low_thrust", "a spacecraft from one orbit to another",
                                                   {"largest_thrust"});
  return problem;
}

}  // namespace lagroid::app
