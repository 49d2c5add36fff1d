#include <lagroid/solvers/boundary_methods.hpp>
#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/kepler.hpp>

namespace lagroid {

LAGROID_SOLVERS(template, Kepler);

}  // namespace lagroid
