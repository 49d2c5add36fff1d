// The rigid body on pairs of attitudes, reduced by all rotations of space.

#include <lagroid/groupoids/morphisms.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include "../../support/reduced_runs.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace reduction_reduced_rigid_body_tests {
namespace {

using Attitude = Matrix<double, 3, 3>;
constexpr int steps = 1000;

/// h l(log(a^T b) / h), as one writes it on pairs of attitudes. `tilt` breaks the symmetry: weight of the far attitude.
struct BodyOnPairs : System<BodyOnPairs, PairOf<SO3>> {
  double h = 0.05;
  Vector<double, 3> inertia{3, 2, 1};
  double tilt = 0;
  template <class A> auto lagrangian(const A& g) const {
    const auto turn = groupoid.quotient(g);
    using S = typename std::remove_cvref_t<decltype(turn)>::Scalar;
    const S kinetic = rotational_action(turn, inertia, h, RotationMap::exponential);
    return S(kinetic + (g.source(2, 2) + g.target(2, 2)) * tilt);
  }
  std::vector<Symmetry<BodyOnPairs>> symmetries() const {
    std::vector<Symmetry<BodyOnPairs>> out;
    for (int i = 0; i < 3; ++i)
      out.push_back({"J" + std::to_string(i + 1), [i](const Attitude& a) { return Vector<double, 3>(a.row(i)); }});
    return out;
  }
};

TEST(Reduction, OfTheRigidBodyIsTheRigidBody) {
  const BodyOnPairs full;
  const auto arrows = arrows_about(full.groupoid, Attitude::Identity().eval());
  const auto reduced = reduce<LeftQuotient<SO3>>({}, full, arrows);
  const Attitude a = SO3::exp(Vector<double, 3>(0.3, 0.1, 0.8));
  const ElementPair<Attitude> start{Attitude::Identity(), a};
  const Vector<double, 3> momentum(1.2, 0.3, -0.5);
  EXPECT_TRUE(agree(run_side_by_side(reduced, reduced, start, momentum, steps)));
  RigidBody body;
  body.h = full.h;
  body.inertia = full.inertia;
  EXPECT_TRUE(agree(run_side_by_side(reduced, body, start, momentum, steps)));
}

TEST(Reduction, KeepsTheStepInOnePlace) {
  ReducedSystem<LeftQuotient<SO3>, BodyOnPairs> reduced;
  reduced.h = 0.2;
  EXPECT_EQ(reduced.full.h, 0.2);
  auto copy = reduced;
  copy.h = 0.3;
  EXPECT_EQ(copy.full.h, 0.3);
  EXPECT_EQ(reduced.full.h, 0.2);
  reduced = copy;
  EXPECT_EQ(reduced.h, 0.3);
  copy.h = 0.4;
  EXPECT_EQ(reduced.full.h, 0.3);
}

TEST(Reduction, WatchesTheFullMomentum) {
  const ReducedSystem<LeftQuotient<SO3>, BodyOnPairs> reduced;
  using Below = std::remove_cvref_t<decltype(reduced)>;
  const Vector<double, 3> momentum(1.2, 0.3, -0.5);
  const Attitude a = SO3::exp(Vector<double, 3>(0.3, 0.1, 0.8));
  FixedStepIntegrator<Below> run(reduced, {{}, momentum}, a, std::make_unique<NewtonStep<Below>>());
  const auto quantities = full_quantities(reduced);
  ASSERT_EQ(quantities.size(), 3U);
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(run.advance().converged());
    for (int i = 0; i < 3; ++i) {
      double value = 0;
      quantities[std::size_t(i)].evaluate(run.point(), &value);
      EXPECT_NEAR(value, (a * momentum)(i), 1e-14);
    }
  }
}

/// The same in every word that the groupoid has for it: the arrow that stands for a turn only looks at the turn.
struct BodyInWords : System<BodyInWords, PairOf<SO3>> {
  double h = 0.05;
  Vector<double, 3> inertia{3, 2, 1};
  template <class A> auto lagrangian(const A& g) const {
    const auto turn = groupoid.tau_inverse(g);
    const auto back = groupoid.tau_inverse(groupoid.inverse(g));
    const auto again = SO3::tau_inverse(SO3::multiply(SO3::inverse(groupoid.source(g)), groupoid.target(g)));
    const auto chart = groupoid.chart(g);
    using S = typename std::remove_cvref_t<decltype(turn)>::Scalar;
    S out(0.0);
    for (int i = 0; i < 3; ++i)
      out = out + (turn(i) * again(i) + back(i) * back(i) + chart(i) * chart(i) - turn(i) * turn(i)) *
                      (0.25 * inertia(i) / h);
    return out;
  }
};

TEST(Reduction, OfALagrangianThatAsksTheGroupoid) {
  const BodyInWords full;
  const auto reduced = reduce<LeftQuotient<SO3>>({}, full, arrows_about(full.groupoid, Attitude::Identity().eval()));
  for (const double size : {0.0, 1e-9, 0.2, 2.0}) {
    const Vector<double, 3> turn = size * Vector<double, 3>(0.6, -0.48, 0.64);
    const Attitude a = SO3::exp(turn);
    const double plain = full.lagrangian(ElementPair<Attitude>{Attitude::Identity(), a});
    EXPECT_NEAR(reduced.lagrangian(a), plain, 1e-13 * (1 + plain)) << size;
  }
  const ElementPair<Attitude> start{Attitude::Identity(), SO3::exp(Vector<double, 3>(0.3, 0.1, 0.8))};
  EXPECT_TRUE(agree(run_side_by_side(reduced, reduced, start, Vector<double, 3>(1.2, 0.3, -0.5), 100)));
}

TEST(BrokenReduction, OfATiltedBodyNamesItsWorstSample) {
  BodyOnPairs tilted;
  tilted.tilt = 1e-3;
  const auto arrows = arrows_about(tilted.groupoid, Attitude::Identity().eval());
  try {
    reduce<LeftQuotient<SO3>>({}, tilted, arrows);
    FAIL() << "a body with weight is not invariant under all rotations";
  } catch (const DoesNotDescend& refused) {
    EXPECT_EQ(refused.report.worst()->ingredient, Ingredient::lagrangian);
    EXPECT_EQ(refused.report.worst()->sample.size(), 18U);
    EXPECT_NE(std::string(refused.what()).find("the Lagrangian does not descend: at the arrow ("), std::string::npos);
  }
  // And the motions differ.
  const ReducedSystem<LeftQuotient<SO3>, BodyOnPairs> claimed(tilted);
  const ElementPair<Attitude> start{Attitude::Identity(), SO3::exp(Vector<double, 3>(0.3, 0.1, 0.8))};
  EXPECT_GT(run_side_by_side(claimed, claimed, start, Vector<double, 3>(1.2, 0.3, -0.5), 20).worst(), 1e-4);
  EXPECT_THROW(reduce<LeftQuotient<SO3>>({}, BodyOnPairs{}, {}), DoesNotDescend) << "nothing was sampled";
}

}  // namespace
}  // namespace reduction_reduced_rigid_body_tests
