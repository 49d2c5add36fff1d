#include <lagroid/systems/control/flows/dubins_car.hpp>

#include "../problem_of.hpp"
#include "pictures.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& dubins_car_problem() {
  static const ControlProblemOf<DubinsCar> problem("dubins_car",
                                                   "a car at unit speed that steers: the shortest way between poses",
                                                   [](const DubinsCar&) { return a_car(); });
  return problem;
}

}  // namespace lagroid::app
