#include <lagroid/systems/control/flows/swing_up.hpp>

#include "../problem_of.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& swing_up_problem() {
  static const ControlProblemOf<SwingUp> problem(
      "swing_up", "a pendulum that a torque swings up",
      [](const SwingUp& pendulum) { return hanging(pendulum.length, "angle"); });
  return problem;
}

}  // namespace lagroid::app
