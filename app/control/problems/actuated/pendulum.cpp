#include <lagroid/systems/control/actuated/pushed.hpp>

#include "../../problem_of.hpp"
#include "../problems.hpp"

namespace lagroid::app {

const ControlProblem& pendulum_problem() {
  static const ControlProblemOf<PushedPendulum> problem(
      "pendulum", "a pendulum moved by a torque, by its own discrete steps",
      [](const PushedPendulum& pushed) { return hanging(pushed.system.length, "angle"); });
  return problem;
}

}  // namespace lagroid::app
