#include <lagroid/solvers/boundary_methods.hpp>
#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/rigid_body.hpp>

namespace lagroid {

LAGROID_SOLVERS(template, RigidBody);

}  // namespace lagroid
