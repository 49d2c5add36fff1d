#include <lagroid/solvers/boundary_methods.hpp>
#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/spherical_pendulum.hpp>

namespace lagroid {

LAGROID_SOLVERS(template, SphericalPendulum);

}  // namespace lagroid
