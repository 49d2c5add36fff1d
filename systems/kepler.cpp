#include <lagroid/systems/kepler.hpp>

namespace lagroid {

LAGROID_STEPS(template, Kepler);

}  // namespace lagroid
