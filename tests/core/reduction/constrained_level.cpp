// A system that is held to a surface, at a fixed momentum: the spherical pendulum in cylinder coordinates by its angle.

#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/pair.hpp>

#include <lagroid/solvers/integrators/integrator_methods.hpp>
#include <lagroid/solvers/integrators/reduced_integrator.hpp>

#include "../../support/level_runs.hpp"

#include <cmath>
#include <vector>

using namespace lagroid;

namespace reduction_constrained_level_tests {
namespace {

using Cylinder = Product<Pair<1>, SO2, Pair<1>>;

/// A bob at (distance from the axis, angle, height) on the unit sphere.
struct Bob : System<Bob, Cylinder, 0, 1> {
  double h = 0.02;
  double gravity = 1;
  template <class S> S lagrangian(const ArrowOf<Cylinder, S>& g) const {
    const auto& [distance, turn, height] = g;
    const S r0 = distance.source(0);
    const S r1 = distance.target(0);
    const S rise = height.target(0) - height.source(0);
    const S squares = r0 * r0 + r1 * r1 - r0 * r1 * turn.trace() + rise * rise;
    return squares * (0.5 / h) - (height.source(0) + height.target(0)) * (0.5 * h * gravity);
  }
  template <class Q> auto object_constraint(const Q& q) const {
    const auto& [distance, turn, height] = q;
    using S = typename std::remove_cvref_t<decltype(distance)>::Scalar;
    return Vector<S, 1>((distance(0) * distance(0) + height(0) * height(0) - 1.0) * 0.5);
  }
};
using ByTheAngle = FactorConnection<Factors<1>, Pair<1>, SO2, Pair<1>>;

/// Tangent to the sphere.
State<Cylinder> start() {
  return {{Vector<double, 1>(0.8), {}, Vector<double, 1>(-0.6)}, Vector<double, 3>(0.3, 0.5, 0.4)};
}

TEST(ConstrainedLevel, OfTheSphericalPendulumLeavesItsHeight) {
  const auto level = level_through(ByTheAngle{}, Bob{}, start());
  static_assert(std::remove_cvref_t<decltype(level)>::object_constraints == 1);
  EXPECT_EQ(level.level(0), 0.5);
  EXPECT_TRUE(agree(run_level_beside(level, start(), 1000)));
}

TEST(ConstrainedLevel, HasTheMultipliersOfTheFullSystem) {
  const auto level = level_through(ByTheAngle{}, Bob{}, start());
  using Level = std::remove_cvref_t<decltype(level)>;
  const auto z = level.state_below(start());
  FixedStepIntegrator<Bob> above(level.full, start(), level.full.groupoid.unit(start().object),
                                 std::make_unique<NewtonStep<Bob>>());
  FixedStepIntegrator<Level> below(level, z, level.groupoid.unit(z.object), std::make_unique<NewtonStep<Level>>());
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(above.advance().converged());
    ASSERT_TRUE(below.advance().converged());
    EXPECT_NEAR(below.point().step.multipliers(0), above.point().step.multipliers(0), 1e-12);
    const auto& [distance, height] = below.point().state.object;
    EXPECT_NEAR(std::hypot(distance(0), height(0)), 1, 1e-14);
  }
}

/// The run at the fixed momentum of the angle, as the full motion over it.
using Reduced = ReducedIntegrator<Bob, FixedMomentum<ByTheAngle>>;
Reduced reduced_run(const Bob& bob, const Composition& composition) {
  const auto declared = fixed_momentum("angle", ByTheAngle{}, "distance and height move");
  return {Reduced::Down(declared, bob, start(), bob.groupoid.unit(start().object)), {.composition = composition}};
}

TEST(ComposedConstrainedLevel, IsTheFullSystemComposed) {
  const Bob bob;
  const auto& cylinder = bob.groupoid;
  const auto full = make_integrator(bob, start(), cylinder.unit(start().object), {.composition = compositions::suzuki});
  Reduced reduced = reduced_run(bob, compositions::suzuki);
  const auto stages = [](const Integrator<Bob>& run) {
    std::vector<Step<Bob>> out;
    run.for_each_inner_stage([&](const Step<Bob>& step, double, double) { out.push_back(step); });
    out.push_back(run.point().step);
    return out;
  };
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(full->advance().converged());
    ASSERT_TRUE(reduced.advance().converged());
    const auto above = stages(*full);
    const auto back = stages(reduced);
    ASSERT_EQ(above.size(), 5U);
    ASSERT_EQ(back.size(), 5U);
    for (std::size_t i = 0; i < above.size(); ++i) {
      EXPECT_NEAR(back[i].multipliers(0), above[i].multipliers(0), 1e-12);
      EXPECT_LT((cylinder.coordinates_of_arrow(back[i].arrow) - cylinder.coordinates_of_arrow(above[i].arrow)).norm(),
                1e-12);
    }
    const auto tangent = [&](const Integrator<Bob>& run) { return tangent_momentum(bob, run.point().state); };
    EXPECT_LT((tangent(reduced) - tangent(*full)).norm(), 1e-11);
    EXPECT_LT((cylinder.coordinates_of_arrow(reduced.point().configuration) -
               cylinder.coordinates_of_arrow(full->point().configuration))
                  .norm(),
              1e-11);
  }
}

/// Where the height is after a second, by steps of that size.
double height_after_a_second(double step, const Composition& composition) {
  Bob bob;
  bob.h = step;
  Reduced run = reduced_run(bob, composition);
  for (long k = std::lround(1 / step); k > 0; --k) EXPECT_TRUE(run.advance().converged());
  return std::get<2>(run.point().state.object)(0);
}

TEST(ComposedConstrainedLevel, IsOfOrderFour) {
  const auto order = [](const Composition& composition) {
    const double coarse = height_after_a_second(0.1, composition);
    const double middle = height_after_a_second(0.05, composition);
    const double fine = height_after_a_second(0.025, composition);
    return std::log2(std::abs((coarse - middle) / (middle - fine)));
  };
  EXPECT_NEAR(order(compositions::suzuki), 4, 0.3);
  EXPECT_NEAR(order(compositions::single), 2, 0.3);
}

TEST(BrokenConstrainedLevel, OfAnotherMomentumIsSeen) {
  auto level = level_through(ByTheAngle{}, Bob{}, start());
  level.level(0) += 1e-6;
  EXPECT_FALSE(agree(run_level_beside(level, start(), 20)));
}

}  // namespace
}  // namespace reduction_constrained_level_tests
