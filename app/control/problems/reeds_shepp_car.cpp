#include <lagroid/systems/control/flows/reeds_shepp_car.hpp>

#include "../problem_of.hpp"
#include "pictures.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& reeds_shepp_car_problem() {
  static const ControlProblemOf<ReedsSheppCar> problem(
      "reeds_shepp_car", "a car that goes forward and backward: the shortest way between poses",
      [](const ReedsSheppCar&) { return a_car(); });
  return problem;
}

}  // namespace lagroid::app
