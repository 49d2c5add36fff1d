#include <lagroid/systems/control/flows/rolled_ball.hpp>

#include "../problem_of.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& rolled_ball_problem() {
  static const ControlProblemOf<RolledBall> problem(
      "rolled_ball", "a ball rolled on a plate, at a bounded speed, to an attitude", {"largest_speed"});
  return problem;
}

}  // namespace lagroid::app
