#include <lagroid/solvers/step_methods.hpp>
#include <lagroid/systems/chaplygin_sleigh.hpp>

namespace lagroid {

LAGROID_STEP_SOLVERS(template, ChaplyginSleigh);

}  // namespace lagroid
