#include <lagroid/systems/control/flows/steered_car.hpp>

#include "../problem_of.hpp"
#include "pictures.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& steered_car_problem() {
  static const ControlProblemOf<SteeredCar> problem("steered_car", "a car that accelerates and steers, as to park",
                                                    {"largest_steering", "largest_steering"},
                                                    [](const SteeredCar&) { return a_car(); });
  return problem;
}

}  // namespace lagroid::app
