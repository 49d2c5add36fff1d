#include <lagroid/solvers/boundary_methods.hpp>
#include <lagroid/solvers/march_methods.hpp>
#include <lagroid/systems/moser_veselov.hpp>

namespace lagroid {

LAGROID_SOLVERS(template, MoserVeselov);

}  // namespace lagroid
