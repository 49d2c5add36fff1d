#include <lagroid/solvers/boundary_methods.hpp>
#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/heavy_top.hpp>

namespace lagroid {

LAGROID_SOLVERS(template, HeavyTop);

}  // namespace lagroid
