// A body with a mass that moves in it, stepped in shape and attitude apart, beside the unsplit system.

#include <lagroid/core/reduction/lagrange_poincare.hpp>

#include "../../support/reduced_runs.hpp"
#include "body_with_a_mass.hpp"

using namespace lagroid;

namespace reduction_lagrange_poincare_run_tests {
namespace {

using Joined = Unsplit<Mechanical>;
using SplitBody = PulledBack<Joined, BodyWithAMass>;
const Vector<double, 2> shape(0.3, -0.2);
const Vector<double, 5> momentum{{0.2, -0.3, 1.2, 0.3, -0.5}};

TEST(LagrangePoincare, MovesAsTheUnsplitSystem) {
  const SplitBody split(BodyWithAMass{}, Joined{});
  const ReducedSystem<Joined, SplitBody> unsplit(split, Joined{});
  EXPECT_TRUE(agree(run_side_by_side(unsplit, BodyWithAMass{}, split.groupoid.unit(shape), momentum, 1000)));
}

/// The largest differences of what leaves an arrow and enters the next over a run, and how much of it is curvature.
struct Matched {
  double horizontal = 0;
  double vertical = 0;
  double curvature = 0;
};
Matched matched(int steps) {
  const SplitBody split(BodyWithAMass{}, Joined{});
  FixedStepIntegrator<SplitBody> run(split, {shape, momentum}, split.groupoid.unit(shape),
                                     std::make_unique<NewtonStep<SplitBody>>());
  if (!run.advance().converged()) throw std::runtime_error("a step failed");
  Matched out;
  for (int i = 0; i < steps; ++i) {
    const auto into = leaving(split, run.point().step);
    if (!run.advance().converged()) throw std::runtime_error("a step failed");
    const auto from = entering(split, run.point().step);
    out.horizontal = std::max(out.horizontal, reduced_difference(into.horizontal, from.horizontal));
    out.vertical = std::max(out.vertical, reduced_difference(into.vertical, from.vertical));
    out.curvature = std::max(out.curvature, (into.curvature - from.curvature).norm());
  }
  return out;
}

TEST(LagrangePoincare, EquationsHoldPartByPartAlongARun) {
  const auto run = matched(200);
  EXPECT_LT(run.horizontal, 1e-13);
  EXPECT_LT(run.vertical, 1e-13);
}

TEST(BrokenLagrangePoincare, WithoutTheCurvatureIsSeen) {
  EXPECT_GT(matched(20).curvature, 1e-3) << "by which horizontal equations without it are off";
}

}  // namespace
}  // namespace reduction_lagrange_poincare_run_tests
