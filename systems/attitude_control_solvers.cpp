#include <lagroid/solvers/boundary_methods.hpp>
#include <lagroid/solvers/step_methods.hpp>
#include <lagroid/systems/attitude_control.hpp>

namespace lagroid {

LAGROID_SOLVERS(template, AttitudeControl);

}  // namespace lagroid
