#include <lagroid/solvers/boundary_methods.hpp>
#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/pendulum.hpp>

namespace lagroid {

LAGROID_SOLVERS(template, Pendulum);

}  // namespace lagroid
