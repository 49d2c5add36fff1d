// The action principle: what is no trajectory is found out. (Trajectories of the library's systems: certificates.cpp.)
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/testing/variational_laws.hpp>

#include "../../support/affine.hpp"
#include "../../support/broken.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace integrators_variational_tests {
namespace {

/// An oscillator; a straight line is no trajectory of it. The boundary term p (q1 - q0) changes nothing but momenta.
struct Oscillator : System<Oscillator, Pair<1>> {
  double h = 0.1;
  double p = 0;
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
    const S dq = g.target(0) - g.source(0);
    return dq * dq * (0.5 / h) - (g.source(0) * g.source(0) + g.target(0) * g.target(0)) * (0.25 * h) + dq * p;
  }
};
TEST(BrokenActionPrinciple, ATrajectoryOfAnotherSystemIsNotCritical) {
  const Oscillator system;
  Path<Oscillator> straight;
  for (int k = 0; k < 4; ++k)
    straight.push_back({{Vector<double, 1>(1 + 0.1 * k), Vector<double, 1>(1.1 + 0.1 * k)}, {}});
  EXPECT_GT(laws::detail::criticality_defect(laws::detail::first_variation(system, straight)), 1e-3);
}

TEST(BrokenActionPrinciple, WhereTheBoundaryTermIsAllEveryPathIsCritical) {
  Oscillator system;
  for (const double p : {0.0, 1e9}) {
    system.p = p;
    const auto report = laws::variational_laws(system, [p] {
      return State<Pair<1>>{Vector<double, 1>(1.0), Vector<double, 1>(p + 0.5 * laws::draw_uniform())};
    });
    EXPECT_TRUE(report.law("trajectories are critical").holds()) << report;
    const auto& neighbours = report.law("admissible neighbours are not");
    EXPECT_TRUE(p == 0 ? neighbours.holds() : laws::seen_broken(neighbours)) << report;
  }
}

/// A free walk on the affine group acting on the line, with one operation wrong.
struct CompensatedTrajectory : System<CompensatedTrajectory, Affine> {
  double h = 0.1;
  explicit CompensatedTrajectory(Fault fault) { groupoid.fault = fault; }
  template <class S> S lagrangian(const AffineArrow<S>& g) const { return (g.a * g.a + g.b * g.b) * (0.5 / h); }
};
TEST(BrokenActionPrinciple, OnAGroupoidThatIsNone) {
  const auto report = [](Fault fault) {
    return laws::variational_laws(CompensatedTrajectory(fault), [] {
      return State<Affine>{Vector<double, 1>(laws::draw_uniform()), {1 + 0.5 * laws::draw_uniform(), 1}};
    });
  };
  const auto sound = report(Fault::none);
  EXPECT_TRUE(sound.holds()) << sound;
  const auto inverse = report(Fault::inverse);
  EXPECT_TRUE(laws::seen_broken(inverse.law("displaced nodes keep the product"))) << inverse;
  const auto target = report(Fault::target);
  EXPECT_TRUE(laws::seen_broken(target.law("variations of two arrows (Theorem 5.1)"))) << target;
}

/// Steps along planes dz = y dx, with derivatives by hand that tilt the planes by a thousandth.
struct Tilted : System<Tilted, Pair<3>, /*arrow constraints*/ 1> {
  double h = 0.1;
  double tilt = 0;
  template <class S> S lagrangian(const PairArrow<S, 3>& g) const {
    return (g.target - g.source).squaredNorm() * (0.5 / h);
  }
  template <class S> Vector<S, 1> constraint(const PairArrow<S, 3>& g) const {
    const Vector<S, 3> dq = g.target - g.source;
    return Vector<S, 1>(dq(2) - (g.source(1) + g.target(1)) * dq(0) * 0.5);
  }
  TwoSided<3, 1> two_sided(const PairArrow<double, 3>& g, const Multipliers& lambda) const {
    auto d = automatic_two_sided(*this, g, lambda);
    d.constraint_target(0, 1) *= 1 + tilt;
    return d;
  }
};
TEST(BrokenActionPrinciple, VariationsThatLeaveTheConstraintAreFoundOut) {
  Tilted system;
  for (const double tilt : {0.0, 1e-3}) {
    system.tilt = tilt;
    const auto report = laws::variational_laws(system, [] {
      return State<Pair<3>>{laws::draw_vector<3>(1.0), {2 + laws::draw_uniform(), laws::draw_uniform(), 1}};
    });
    EXPECT_TRUE(tilt != 0 || report.holds()) << report;
    for (const char* law : {"variations of two arrows (Theorem 5.1)", "two arrows of the dynamics are critical",
                            "trajectories are critical"})
      EXPECT_EQ(laws::seen_broken(report.law(law)), tilt != 0) << report;
  }
}

}  // namespace
}  // namespace integrators_variational_tests
