#include <lagroid/systems/pendulum.hpp>

namespace lagroid {

LAGROID_STEPS(template, Pendulum);

}  // namespace lagroid
