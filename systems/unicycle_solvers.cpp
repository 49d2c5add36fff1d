#include <lagroid/solvers/boundary_methods.hpp>
#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/unicycle.hpp>

namespace lagroid {

LAGROID_SOLVERS(template, Unicycle);

}  // namespace lagroid
