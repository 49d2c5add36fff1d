#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/rolling_ball.hpp>

namespace lagroid {

LAGROID_STEP_SOLVERS(template, RollingBall);

}  // namespace lagroid
