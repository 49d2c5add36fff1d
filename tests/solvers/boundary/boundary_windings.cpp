// Boundary values whose cheapest paths wind: what groupoids and systems say of loops, and what the multistart makes of
// it.
#include <lagroid/groupoids/groups/orthogonal.hpp>
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/groupoids/pair_of.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/groupoids/time_extended.hpp>
#include <lagroid/solvers/boundary/boundary_methods.hpp>
#include <lagroid/systems/pendulums/driven_pendulum.hpp>

#include "boundary_cases.hpp"
#include "boundary_ends.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <stdexcept>

using namespace lagroid;

namespace boundary_boundary_windings_tests {
namespace {

/// A groupoid as a user would write it: angles that are added, as points of the circle.
struct Dial : LieGroupoid<Dial, 1> {
  template <class S> using Arrow = Vector<S, 2>;
  template <class S> using Object = Vector<S, 0>;
  template <class S> static Object<S> source(const Vector<S, 2>&) { return {}; }
  template <class S> static Object<S> target(const Vector<S, 2>&) { return {}; }
  template <class S> static Vector<S, 2> unit(const Vector<S, 0>&) { return {S(1), S(0)}; }
  template <class S> static Vector<S, 2> inverse(const Vector<S, 2>& g) { return {g(0), -g(1)}; }
  template <class S> static Vector<S, 2> multiply(const Vector<S, 2>& g, const Vector<S, 2>& h) {
    return {g(0) * h(0) - g(1) * h(1), g(0) * h(1) + g(1) * h(0)};
  }
  template <class S> static Vector<S, 2> tau(const Vector<S, 0>&, const Vector<S, 1>& v) {
    using std::cos, std::sin;
    return {cos(v(0)), sin(v(0))};
  }
  template <class S> static Vector<S, 1> tau_inverse(const Vector<S, 2>& g) {
    using std::atan2;
    return Vector<S, 1>(atan2(g(1), g(0)));
  }
  static constexpr int loops = 1;
  static Vector<double, 2> loop(const Vector<double, 0>& q, const Vector<double, 1>&, const Vector<double, 1>& turns) {
    return tau(q, Vector<double, 1>(2 * std::numbers::pi * turns));
  }
  static std::string name() { return "dial"; }
};

/// Two hands that would rather turn at rates of their own: L = h |(turn rates) - drift|^2 / 2. The cheapest way between
/// two readings turns evenly, as often as brings the rates nearest to the drift.
struct Clock : System<Clock, Product<Dial, Dial>> {
  double h = 0.1;
  Vector<double, 2> drift{2, -1.5};
  template <class S> S lagrangian(const Arrow<S>& g) const {
    const Vector<S, 2> turned = groupoid.tau_inverse(g);
    const S first = turned(0) * (1 / h) - drift(0);
    const S second = turned(1) * (1 / h) - drift(1);
    return (first * first + second * second) * (0.5 * h);
  }
};

template <class T> struct Loops : ::testing::Test {};
using Winders = ::testing::Types<SO2, SE2, SO3, SE3, Orthogonal<5>, Product<Pair<2>, SO3>, Product<SE2, Pair<1>, SO3>,
                                 Action<SO3, RotatedDirections>, PairOf<SE3>, Dial, Product<Dial, Dial>>;
TYPED_TEST_SUITE(Loops, Winders);

/// What loops.hpp asks of W's loops at the source of g, on the groupoid G.
template <class G, class W> void expect_loops(const G& groupoid, const W& winder, const ObjectOf<G>& q) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> integer(-3, 3);
  const auto gap = [&](const ArrowOf<G>& a, const ArrowOf<G>& b) {
    return (groupoid.coordinates_of_arrow(a) - groupoid.coordinates_of_arrow(b)).norm();
  };
  for (int trial = 0; trial < 20; ++trial) {
    AlgebroidVector<G> axis;
    for (auto& x : axis) x = normal(generator);
    Vector<double, loops_of<W>()> turns;
    for (auto& k : turns) k = integer(generator);
    EXPECT_LT(gap(winder.loop(q, axis, turns), groupoid.unit(q)), 1e-13);
    if (turns.isZero()) continue;
    using Turns = decltype(turns);
    double farthest = 0;
    for (int k = 1; k < 50; ++k) {
      const auto at = winder.loop(q, axis, Turns(turns * (k / 50.0)));
      const auto next = winder.loop(q, axis, Turns(turns * ((k + 1e-3) / 50.0)));
      EXPECT_LT((groupoid.coordinates_of_object(groupoid.source(at)) - groupoid.coordinates_of_object(q)).norm(),
                1e-13);
      EXPECT_LT(gap(groupoid.project(at), at), 1e-13);
      EXPECT_LT(gap(at, next), 0.01);
      farthest = std::max(farthest, gap(at, groupoid.unit(q)));
    }
    EXPECT_GT(farthest, 0.5);
  }
}

TYPED_TEST(Loops, CloseWhereTurnsAreWhole) {
  static_assert(Winding<TypeParam>);
  const TypeParam groupoid{};
  auto q = groupoid.source(groupoid.template arrow_at<double>(Vector<double, TypeParam::arrow_coordinate_count()>(
      Vector<double, TypeParam::arrow_coordinate_count()>::Zero())));
  if constexpr (std::is_same_v<TypeParam, Action<SO3, RotatedDirections>>) q = Vector<double, 3>(0.6, 0, 0.8);
  if constexpr (std::is_same_v<TypeParam, PairOf<SE3>>) q = Matrix<double, 4, 4>::Identity();
  expect_loops(groupoid, groupoid, q);
}

TEST(LoopsOfSystems, GoAroundTheCentreAndTheVertical) {
  expect_loops(Pair<2>(), Kepler(), Vector<double, 2>(1, 0.5));
  expect_loops(Pair<3>(), SphericalPendulum(), Vector<double, 3>(0.6, 0.3, -0.7));
}

TEST(Windings, TheUnicyclesCheapestPathIsFoundFromAnySeed) {
  const auto solver = make_boundary_solver<Unicycle>();
  for (const auto& [stage, cost] : wound_ends())
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      MultistartOptions options;
      options.seed = seed;
      const auto found = solve_boundary(*solver, stage.problem, stage.steps, options);
      ASSERT_FALSE(found.solutions.empty());
      const auto& best = found.solutions.front();
      EXPECT_LT(best.cost, cost * (1 + 1e-8)) << stage.problem.boundary;
      EXPECT_TRUE(best.kind.is_minimum);
      EXPECT_GE(best.starts, 2);
    }
}

TEST(Windings, StartsAreCountedOnce) {
  const auto stage = unicycle_to(-1, 0.2, 0);
  const auto found = solve_boundary(*make_boundary_solver<Unicycle>(), stage.problem, stage.steps);
  EXPECT_EQ(found.starts, 40);
  int led = 0;
  for (const auto& solution : found.solutions) led += solution.starts;
  EXPECT_LE(led, found.outcomes.at(SolveStatus::converged));
  EXPECT_GE(led, 20);
}

TEST(Windings, AUsersOwnGroupoidWinds) {
  // Each hand takes the number of turns that comes nearest to its drift.
  for (const auto& end : {Vector<double, 2>(2, 2.5), Vector<double, 2>(-0.5, -1), Vector<double, 2>(3, -3)}) {
    Clock system;
    constexpr std::size_t steps = 30;
    const double duration = system.h * double(steps);
    double least = 0;
    for (int i = 0; i < 2; ++i) {
      double nearest = 1e300;
      for (int k = -3; k <= 3; ++k) {
        const double rate = (end(i) + 2 * std::numbers::pi * k) / duration - system.drift(i);
        nearest = std::min(nearest, rate * rate);
      }
      least += 0.5 * duration * nearest;
    }
    const auto boundary = system.groupoid.tau(system.groupoid.source(ArrowOf<Product<Dial, Dial>>()), end);
    const auto found = solve_boundary(*make_boundary_solver<Clock>(), BoundaryProblem<Clock>{system, boundary}, steps);
    ASSERT_FALSE(found.solutions.empty());
    EXPECT_NEAR(found.solutions.front().cost, least, 1e-9);
  }
}

TEST(Windings, KeplersRevolutionsAreFound) {
  // A quarter of the unit circle, and a whole turn besides.
  Kepler system;
  constexpr std::size_t steps = 200;
  system.h = 2.5 * std::numbers::pi / double(steps);
  const BoundaryProblem<Kepler> problem{system, {{1, 0}, {0, 1}}};
  const auto found = solve_boundary(*make_boundary_solver<Kepler>(), problem, steps);
  const auto revolves = [&](const BoundarySolution<Kepler>& solution) {
    double angle = 0;
    for (const auto& step : solution.path) {
      const auto& [from, to] = step.arrow;
      angle += std::atan2(from(0) * to(1) - from(1) * to(0), from.dot(to));
    }
    return std::lround((angle - std::numbers::pi / 2) / (2 * std::numbers::pi));
  };
  bool circle = false;
  for (const auto& solution : found.solutions)
    circle = circle || (revolves(solution) == 1 && std::abs(solution.cost - 3.75 * std::numbers::pi) < 1e-2);
  EXPECT_TRUE(circle);
}

TEST(TimedBoundary, FindsTheMotionOfADrivenSystem) {
  DrivenPendulum system;
  system.h = 0.02;
  system.torque = 0.5;
  system.amplitude = 0.1;
  constexpr std::size_t steps = 40;
  const State<Pair<1>> start{Vector<double, 1>(0.4), Vector<double, 1>(0.9)};
  FixedStepIntegrator<DrivenPendulum> integrator(system, start, system.groupoid.unit(start.object),
                                                 std::make_unique<NewtonStep<DrivenPendulum>>());
  for (std::size_t k = 0; k < steps; ++k) ASSERT_TRUE(integrator.advance().converged());
  using Timed = FixedStep<DrivenPendulum>;
  const Timed timed(system, ConstantStep{system.h});
  const BoundaryProblem<Timed> problem{
      timed, timed_boundary<DrivenPendulum>(integrator.point().configuration, system.time, system.h, steps)};
  const auto found = solve_boundary(*make_boundary_solver<Timed>(), problem, steps);
  const bool met = std::any_of(found.solutions.begin(), found.solutions.end(), [&](const auto& solution) {
    return std::abs(initial_momentum(timed, solution.path)(1) - start.momentum(0)) < 1e-8;
  });
  EXPECT_TRUE(met);
}

TEST(Configuration, ThatEndsElsewhereIsRefused) {
  const Kepler system = kepler();
  const State<Pair<2>> start{{1, 0}, {0, 1}};
  const auto begun = [&](const PairArrow<double, 2>& configuration) {
    FixedStepIntegrator<Kepler>(system, start, configuration, std::make_unique<NewtonStep<Kepler>>());
  };
  EXPECT_NO_THROW(begun({{0.3, 0.2}, {1, 0}}));
  EXPECT_THROW(begun({{1, 0}, {0.9, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace boundary_boundary_windings_tests
