#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/rolling_disk.hpp>

namespace lagroid {

LAGROID_STEP_SOLVERS(template, RollingDisk);

}  // namespace lagroid
