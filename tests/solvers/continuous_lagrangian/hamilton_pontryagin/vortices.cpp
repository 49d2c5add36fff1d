// Point vortices by their degenerate Lagrangian.
#include "vortices.hpp"
#include "energy_errors.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace hamilton_pontryagin_vortices_tests {
namespace {

TEST(PrimaryConstraint, FourVortices) {
  const Vector<double, 8> start = vortices_start;
  const PrimaryConstraintStep<Midpoint<Vortices>> by(Midpoint<Vortices>{});
  const auto [first, last] = energy_errors(by, start, 0.1, 3000);
  EXPECT_GT(first, 1e-9);
  EXPECT_LT(last, 3 * first);  // the motion is chaotic: close passages are not the same in each tenth
  // The impulse and the angular impulse, which are quadratic, by a rule that keeps them.
  auto z = by.on(start);
  const Vector<double, 4> g = Vortices{}.strength;
  const auto impulses = [&](const Vector<double, 8>& q) {
    Vector<double, 3> sum(0, 0, 0);
    for (int i = 0; i < 4; ++i) {
      const Vector<double, 2> at = q.segment<2>(2 * i);
      sum += g(i) * Vector<double, 3>(at(0), at(1), at.squaredNorm());
    }
    return sum;
  };
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(by.step(z, 0.1), SolveStatus::converged);
  EXPECT_LT((impulses(z.object) - impulses(start)).norm(), 1e-12);
}

}  // namespace
}  // namespace hamilton_pontryagin_vortices_tests
