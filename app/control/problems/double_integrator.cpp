#include <lagroid/systems/control/flows/double_integrator.hpp>

#include "../problem_of.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& double_integrator_problem() {
  static const ControlProblemOf<DoubleIntegrator> problem(
      "double_integrator", "a mass on a line under a force, its speed bounded", {"largest_speed", "largest_speed"});
  return problem;
}

}  // namespace lagroid::app
