#include <lagroid/systems/control/flows/hovercraft.hpp>

#include "../problem_of.hpp"
#include "pictures.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& hovercraft_problem() {
  static const ControlProblemOf<Hovercraft> problem("hovercraft", "a hovercraft with one engine and a torque",
                                                    [](const Hovercraft&) { return a_car(); });
  return problem;
}

}  // namespace lagroid::app
