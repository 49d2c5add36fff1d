#include <lagroid/solvers/factored_square.hpp>
#include <lagroid/solvers/small_inverse.hpp>

namespace lagroid {

LAGROID_FOR_SMALL_SIZES(template class FactoredSquare);
LAGROID_FOR_SMALL_SIZES(template class SmallInverse);

}  // namespace lagroid
