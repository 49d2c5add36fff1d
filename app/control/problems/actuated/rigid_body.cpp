#include <lagroid/systems/control/actuated/pushed.hpp>

#include "../../problem_of.hpp"
#include "../problems.hpp"

namespace lagroid::app {

const ControlProblem& rigid_body_problem() {
  static const ControlProblemOf<PushedBody> problem(
      "rigid_body", "a rigid body turned by torques, by its own discrete steps", [](const PushedBody& pushed) {
        const auto& i = pushed.system.inertia;
        return std::vector<Shape>{box_of({i(0), i(1), i(2)})};
      });
  return problem;
}

}  // namespace lagroid::app
