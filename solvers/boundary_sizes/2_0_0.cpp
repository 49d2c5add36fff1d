#include <lagroid/solvers/boundary_methods.hpp>

namespace lagroid::detail {

LAGROID_BOUNDARY_SIZES(template, 2, 0, 0, 16);

}  // namespace lagroid::detail
