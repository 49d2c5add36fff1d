#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/driven_body.hpp>

namespace lagroid {

LAGROID_STEP_SOLVERS(template, DrivenBody);

}  // namespace lagroid
