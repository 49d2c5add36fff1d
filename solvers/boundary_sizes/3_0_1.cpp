#include <lagroid/solvers/boundary_methods.hpp>

namespace lagroid::detail {

LAGROID_BOUNDARY_SIZES(template, 3, 0, 1, 16);

}  // namespace lagroid::detail
