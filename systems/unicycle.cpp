#include <lagroid/systems/unicycle.hpp>

namespace lagroid {

LAGROID_STEPS(template, Unicycle);

}  // namespace lagroid
