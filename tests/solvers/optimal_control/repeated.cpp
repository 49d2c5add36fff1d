// Constraints that say what others say are told by their rows; those that contradict others are infeasible.
#include "support.hpp"

#include <lagroid/systems/control/flows/double_integrator.hpp>
#include <lagroid/systems/control/flows/planar_mass.hpp>

#include <vector>

namespace lagroid::optimal_control_repeated_tests {
namespace {

/// From rest to where these functions of the last node vanish.
template <int M, class Psi> ControlTask<PlanarMass> to_where(Psi psi) {
  ControlTask<PlanarMass> task{{}, {{0, 0, 0, 0}, {2, 1, 0, 0}}, 2};
  task.free_end.fill(true);
  task.end_condition = node_condition<Pair<4>, M>(psi);
  return task;
}

ControlReport solved(const ControlTask<PlanarMass>& task, int iterations = 200) {
  return solve_control(task, 20, {.max_iterations = iterations}).report;
}

TEST(RepeatedConstraints, AreToldWhetherTheSolveConvergedOrNot) {
  // Twice the first, and the sum of the others.
  const auto task = to_where<4>([]<class S>(const PairArrow<S, 4>& p) {
    const S x = p.target(0) - 2.0;
    const S y = p.target(1) - 1.0;
    return Vector<S, 4>(x, 2.0 * x, y, x + y);
  });
  for (const int iterations : {1, 200}) {
    const ControlReport report = solved(task, iterations);
    ASSERT_EQ(report.repeated.size(), 2U) << to_string(report.status);
    EXPECT_EQ(report.repeated[0].stage, 19);
    EXPECT_EQ(report.repeated[0].row, 5);
    EXPECT_EQ(report.repeated[0].of, std::vector<int>{4});
    EXPECT_EQ(report.repeated[1].row, 7);
    EXPECT_EQ(report.repeated[1].of, (std::vector<int>{4, 6}));
    if (report.converged()) continue;
    EXPECT_EQ(report.status, ControlStatus::redundant);
    EXPECT_NE(report.message.find("leave out what says the same"), std::string::npos) << report.message;
  }
}

// The same circle, as a square and as a root.
TEST(RepeatedConstraints, NeedNotBeLinear) {
  const auto task = to_where<2>([]<class S>(const PairArrow<S, 4>& p) {
    using std::sqrt;
    const S square = p.target(0) * p.target(0) + p.target(1) * p.target(1);
    return Vector<S, 2>(square - 4.0, sqrt(square) - 2.0);
  });
  const ControlReport report = solved(task);
  ASSERT_EQ(report.repeated.size(), 1U) << to_string(report.status);
  EXPECT_EQ(report.repeated[0].row, 5);
}

TEST(RepeatedConstraints, AreNoneWhereTheyContradict) {
  const auto contradiction =
      to_where<2>([]<class S>(const PairArrow<S, 4>& p) { return Vector<S, 2>(p.target(0) - 2.0, p.target(0) - 1.0); });
  const ControlReport report = solved(contradiction);
  EXPECT_EQ(report.status, ControlStatus::infeasible);
  EXPECT_TRUE(report.repeated.empty());
  const auto two =
      to_where<2>([]<class S>(const PairArrow<S, 4>& p) { return Vector<S, 2>(p.target(0) - 2.0, p.target(1) - 1.0); });
  EXPECT_TRUE(solved(two).converged());
  EXPECT_TRUE(solved(two).repeated.empty());
}

/// Its second equation stands there twice.
struct Stuttering : ControlSystem<Stuttering, Pair<2>, 1, 3> {
  template <class S> S cost(const PairArrow<S, 2>&, const Vector<S, 1>& u, const S& h) const { return h * u(0) * u(0); }
  template <class S> Vector<S, 3> constraint(const PairArrow<S, 2>& g, const Vector<S, 1>& u, const S& h) const {
    const S x = g.target(0) - g.source(0) - h * 0.5 * (g.source(1) + g.target(1));
    const S v = g.target(1) - g.source(1) - h * u(0);
    return {x, v, v};
  }
};

TEST(RepeatedConstraints, OfEveryStageAreToldOnce) {
  const auto found = solve_control(ControlTask<Stuttering>{{}, {{0, 0}, {1, 0}}, 1}, 10);
  ASSERT_EQ(found.report.repeated.size(), 1U) << to_string(found.report.status);
  EXPECT_EQ(found.report.repeated[0].stage, 0);
  EXPECT_EQ(found.report.repeated[0].stages, 10);
  EXPECT_EQ(found.report.repeated[0].row, 2);
  EXPECT_EQ(found.report.repeated[0].of, std::vector<int>{1});
}

// On one side alone, each way.
TEST(ControlBounds, HoldOnOneSideAlone) {
  for (const double side : {1.0, -1.0}) {
    ControlTask<DoubleIntegrator> task{{}, {{0, 0}, {side, 0}}, 1};
    (side > 0 ? task.lower : task.upper)(0) = -4 * side;
    const auto found = solve_control(task, 50);
    ASSERT_TRUE(found.report.converged()) << found.report.message;
    ASSERT_EQ(found.inequality_multipliers.front().size(), 3U);  // two of the speed, and the one that there is
    double farthest = 0;
    double nearest = 0;
    for (const auto& u : found.trajectory.controls) {
      farthest = std::min(farthest, side * u(0));
      nearest = std::max(nearest, side * u(0));
    }
    EXPECT_NEAR(farthest, -4, 1e-9);
    EXPECT_GT(nearest, 6);  // without a bound 6 at either end
  }
}

}  // namespace
}  // namespace lagroid::optimal_control_repeated_tests
