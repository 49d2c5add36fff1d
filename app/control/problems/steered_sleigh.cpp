#include <lagroid/systems/control/flows/steered_sleigh.hpp>

#include "../problem_of.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& steered_sleigh_problem() {
  static const ControlProblemOf<SteeredSleigh> problem("steered_sleigh", "a sleigh on a blade, pushed and turned");
  return problem;
}

}  // namespace lagroid::app
