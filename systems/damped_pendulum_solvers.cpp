#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/damped_pendulum.hpp>

namespace lagroid {

LAGROID_STEP_SOLVERS(template, DampedPendulum);

}  // namespace lagroid
