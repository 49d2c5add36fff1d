// The library's own suites on a discretised Lagrangian with a constraint.
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>

#include "laws.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace continuous_lagrangian_laws_constrained_tests {
namespace {

TEST(AnyLagrangian, LawsOfAConstrainedMotion) {
  expect_laws(Midpoint<Area>{Area{}, 0.1}, [] {
    return State<Pair<3>>{{0.5 * laws::draw_uniform(), 0.3, 0.1}, {0.5, laws::draw_uniform(), 1}};
  });
}

}  // namespace
}  // namespace continuous_lagrangian_laws_constrained_tests
