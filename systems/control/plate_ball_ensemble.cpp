#include <lagroid/systems/ensembles.hpp>

namespace lagroid {

LAGROID_ENSEMBLE(template, PlateBall);

}  // namespace lagroid
