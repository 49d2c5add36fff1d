// The library's own suites on a discretised Lagrangian on an action groupoid.
#include <lagroid/solvers/galerkin/galerkin.hpp>

#include "laws.hpp"

#include <cmath>

using namespace lagroid;
using namespace lagroid::subjects;

namespace continuous_lagrangian_laws_of_a_top_tests {
namespace {

State<Top::GroupoidType> draw_top() {
  const double tilt = laws::draw_uniform();
  return {{std::sin(tilt), 0, std::cos(tilt)}, {0.3 * laws::draw_uniform(), 0.4, 1 + 0.3 * laws::draw_uniform()}};
}

TEST(AnyLagrangian, LawsOfATop) { expect_laws(Galerkin<Top, 2>{Top{}, 0.1}, draw_top); }

}  // namespace
}  // namespace continuous_lagrangian_laws_of_a_top_tests
