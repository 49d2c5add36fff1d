#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/driven_pendulum.hpp>

namespace lagroid {

LAGROID_STEP_SOLVERS(template, DrivenPendulum);

}  // namespace lagroid
