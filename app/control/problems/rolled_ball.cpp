#include <lagroid/systems/control/flows/rolled_ball.hpp>

#include "../problem_of.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& rolled_ball_problem() {
  static const ControlProblemOf<RolledBall> problem("rolled_ball",
                                                    "a ball rolled on a plate, at a bounded speed, to an attitude",
                                                    {"largest_speed"}, [](const RolledBall& rolled) {
                                                      Shape ball = ball_on_plate(rolled.radius);
                                                      ball.transposed = true;
                                                      return std::vector<Shape>{ball, turning_plate(rolled.plate_rate)};
                                                    });
  return problem;
}

}  // namespace lagroid::app
