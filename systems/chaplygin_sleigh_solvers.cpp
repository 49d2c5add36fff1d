#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/chaplygin_sleigh.hpp>

namespace lagroid {

LAGROID_STEP_SOLVERS(template, ChaplyginSleigh);

}  // namespace lagroid
