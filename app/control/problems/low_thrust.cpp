#include <lagroid/systems/control/flows/low_thrust.hpp>

#include "../problem_of.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& low_thrust_problem() {
  static const ControlProblemOf<LowThrust> problem("low_thrust", "a spacecraft from one orbit to another",
                                                   {"largest_thrust"}, [](const LowThrust&) {
                                                     Shape craft{"sphere", {0.05}};
                                                     craft.position = {"x", "y", 0.0};
                                                     craft.trail = true;
                                                     return std::vector<Shape>{{"sphere", {0.1}}, craft};
                                                   });
  return problem;
}

}  // namespace lagroid::app
