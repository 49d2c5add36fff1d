// Point vortices by their degenerate Lagrangian, for long.
#include "energy_errors.hpp"
#include "vortices.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace hamilton_pontryagin_vortices_for_long_tests {
namespace {

TEST(PrimaryConstraint, FourVorticesForAHundredThousandSteps) {
  const PrimaryConstraintStep<Midpoint<Vortices>> by(Midpoint<Vortices>{});
  const auto [first, last] = energy_errors(by, vortices_start, 0.1, 100000);
  EXPECT_GT(first, 1e-9);
  EXPECT_LT(last, 3 * first);  // the motion is chaotic: close passages are not the same in each tenth
}

}  // namespace
}  // namespace hamilton_pontryagin_vortices_for_long_tests
