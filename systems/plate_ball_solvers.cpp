#include <lagroid/solvers/boundary_methods.hpp>
#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/plate_ball.hpp>

namespace lagroid {

LAGROID_SOLVERS(template, PlateBall);

}  // namespace lagroid
