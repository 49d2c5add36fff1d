#include <lagroid/solvers/boundary_methods.hpp>
#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/attitude_control.hpp>

namespace lagroid {

LAGROID_SOLVERS(template, AttitudeControl);

}  // namespace lagroid
