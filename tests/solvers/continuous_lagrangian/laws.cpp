// The library's own suites on a discretised Lagrangian of order six.
#include <lagroid/solvers/galerkin/galerkin.hpp>

#include "laws.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace continuous_lagrangian_laws_tests {
namespace {

State<Pair<2>> draw_orbit() {
  return {{1 + 0.2 * laws::draw_uniform(), 0.1 * laws::draw_uniform()},
          {0.2 * laws::draw_uniform(), 1 + 0.2 * laws::draw_uniform()}};
}

// Derivatives through the inner solve, Poisson steps, Noether: as of a system that was written by hand.
TEST(AnyLagrangian, LawsOfAnOrbit) { expect_laws(Galerkin<Orbit, 3>{Orbit{}, 0.1}, draw_orbit); }

}  // namespace
}  // namespace continuous_lagrangian_laws_tests
