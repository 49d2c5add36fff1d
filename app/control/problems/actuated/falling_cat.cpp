#include <lagroid/systems/control/actuated/falling_cat.hpp>

#include "../../problem_of.hpp"
#include "../problems.hpp"

namespace lagroid::app {

const ControlProblem& falling_cat_problem() {
  static const ControlProblemOf<BendingCat> problem(
      "falling_cat", "a cat that turns in the air by torques between its halves, by discrete steps",
      {"largest_bend", "turn of a step", "bend of a step"});
  return problem;
}

}  // namespace lagroid::app
