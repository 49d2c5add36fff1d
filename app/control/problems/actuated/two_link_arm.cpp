#include <lagroid/systems/control/actuated/two_link_arm.hpp>

#include "../../problem_of.hpp"
#include "../problems.hpp"

namespace lagroid::app {

const ControlProblem& two_link_arm_problem() {
  static const ControlProblemOf<PushedArm> problem("two_link_arm",
                                                   "an arm of two links that keeps out of a disk, by discrete steps",
                                                   {"disk_radius", "disk_radius", "disk_radius", "disk_radius"});
  return problem;
}

}  // namespace lagroid::app
