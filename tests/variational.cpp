// The action principle: what is no trajectory is found out. (Trajectories of the library's systems: certificates.cpp.)
#include <lagroid/solvers/testing/variational_laws.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace {

/// An oscillator; a straight line is no trajectory of it.
struct Oscillator : System<Oscillator, Pair<1>> {
  double h = 0.1;
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
    const S dq = g.target(0) - g.source(0);
    return dq * dq * (0.5 / h) - (g.source(0) * g.source(0) + g.target(0) * g.target(0)) * (0.25 * h);
  }
};
TEST(BrokenActionPrinciple, ATrajectoryOfAnotherSystemIsNotCritical) {
  const Oscillator system;
  Path<Oscillator> straight;
  for (int k = 0; k < 4; ++k)
    straight.push_back({{Vector<double, 1>(1 + 0.1 * k), Vector<double, 1>(1.1 + 0.1 * k)}, {}});
  EXPECT_GT(laws::detail::criticality_defect(laws::detail::first_variation(system, straight)), 1e-3);
}

}  // namespace
