#include <lagroid/systems/control/flows/planar_mass.hpp>

#include "../problem_of.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& planar_mass_problem() {
  static const ControlProblemOf<PlanarMass> problem("planar_mass", "a mass in the plane that keeps out of a disk",
                                                    {"largest_force", "disk_radius"});
  return problem;
}

}  // namespace lagroid::app
