// Boundary values whose step sizes are part of the path: motions that return to their initial values, that are driven,
// that have no such steps, or whose steps are prescribed.
#include <lagroid/solvers/boundary/times/free_steps.hpp>

#include <lagroid/solvers/boundary/times/prescribed_steps.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/driven_pendulum.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>

#include "paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

using namespace lagroid;

namespace free_steps_motions_tests {
namespace {

TEST(FreeSteps, OfASwingHaveTheSameEnergyOnAllArrows) {
  Pendulum pendulum;
  pendulum.h = 2.0 / 50;
  const PairArrow<double, 1> swing{Vector<double, 1>(-0.8), Vector<double, 1>(1.0)};
  expect_one_energy(pendulum, free_steps(pendulum, swing, 50));
}

// The same arrows as an initial value, with the step as an unknown.
TEST(FreeSteps, SurviveTheirInitialValueProblem) {
  Pendulum system;
  constexpr std::size_t steps = 20;
  system.h = 2.0 / steps;
  const PairArrow<double, 1> swing{Vector<double, 1>(-0.8), Vector<double, 1>(1.0)};
  const auto path = free_steps(system, swing, steps);
  ASSERT_TRUE(path.converged()) << path.message;
  system.h = path.times[1];
  const auto run = make_integrator(system, legendre_minus(system, path.path[0]), {swing.source, swing.source},
                                   {.mode = TimeMode::adaptive});
  for (std::size_t k = 1; k <= steps; ++k) {
    ASSERT_TRUE(run->advance().converged()) << k;
    EXPECT_NEAR(run->point().time, path.times[k], 1e-7);
    EXPECT_NEAR(run->point().step.arrow.target(0), path.path[k - 1].arrow.target(0), 1e-7);
  }
}

TEST(FreeSteps, SaySoWhereThereAreNone) {
  Pendulum system;
  constexpr std::size_t steps = 20;
  system.h = 2.0 / steps;
  system.quadrature = Quadrature::trapezoid;
  const PairArrow<double, 1> swing{Vector<double, 1>(-0.8), Vector<double, 1>(1.0)};
  const auto none = free_steps(system, swing, steps);
  EXPECT_EQ(none.status, SolveStatus::no_step) << none.message;
  EXPECT_NE(none.message.find("changes its sign along the path"), std::string::npos) << none.message;
  // Uniform motion: any steps will do.
  system.gravity = 0;
  EXPECT_EQ(free_steps(system, swing, steps).status, SolveStatus::degenerate);
}

// Where the Lagrangian depends on time the energy changes as time itself makes it.
TEST(FreeSteps, BalanceTheEnergyOfADrivenMotion) {
  DrivenPendulum system;
  system.torque = 0.2;
  system.frequency = 1.3;
  system.time = 0.7;
  constexpr std::size_t steps = 40;
  system.h = 2.0 / steps;
  const auto motion = [&](double h, std::size_t count) {
    DrivenPendulum of = system;
    of.h = h;
    FixedStepIntegrator<DrivenPendulum> run(of, {Vector<double, 1>(-0.8), Vector<double, 1>(0.9)},
                                            {Vector<double, 1>(-0.8), Vector<double, 1>(-0.8)},
                                            std::make_unique<NewtonStep<DrivenPendulum>>());
    Path<DrivenPendulum> path;
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_TRUE(run.advance().converged());
      path.push_back(run.point().step);
    }
    return path;
  };
  TimedSolution<DrivenPendulum> equal;
  equal.path = motion(system.h, steps);
  equal.times = equal_times(system.time, system.h, steps);
  const PairArrow<double, 1> ends{equal.path.front().arrow.source, equal.path.back().arrow.target};
  const auto free = solve_free_steps(system, ends, equal);
  ASSERT_TRUE(free.converged()) << to_string(free.status) << " " << free.message;
  EXPECT_EQ(free.times.front(), 0.7);
  using D = Dual<double>;
  double changed = 0;
  double off = 0;
  double unequal = 0;
  const auto energy = [&](std::size_t k) {
    return discrete_energy(system, free.path[k], free.times[k], free.times[k + 1] - free.times[k]);
  };
  for (std::size_t k = 1; k < steps; ++k) {
    // p_t = -E_d at the end of an arrow; at its start dL/dt is wanting.
    const double h = free.times[k + 1] - free.times[k];
    const double by_time =
        system.lagrangian(system.groupoid.cast<D>(free.path[k].arrow), D(free.times[k], 1.0), D(h)).derivative;
    off = std::max(off, std::abs(energy(k - 1) - energy(k) - by_time));
    changed = std::max(changed, std::abs(by_time));
    unequal = std::max(unequal, std::abs(h / system.h - 1));
  }
  EXPECT_LT(off, 1e-12);
  EXPECT_GT(changed, 1e-3);
  EXPECT_GT(unequal, 1e-2);
}

// Lambert's problem with steps as |q|^(3/2).
TEST(PrescribedSteps, AreOfOrderTwoAndTheirMultipliersSmall) {
  const PairArrow<double, 2> ends{{1, 0}, {-0.3, 0.8}};
  std::vector<double> costs;
  std::vector<double> multipliers;
  for (const std::size_t steps : {20, 40, 80}) {
    Kepler system;
    system.h = 2.0 / double(steps);
    const auto path = solve_prescribed_steps(system, ends, equal_steps(system, ends, steps));
    ASSERT_TRUE(path.converged()) << to_string(path.status) << " " << path.message;
    costs.push_back(path.cost);
    double largest = 0;
    double mean = 0;
    double off = 0;
    double unequal = 0;
    double drift = 0;
    const double epsilon = path.times[1] / system.time_scale(path.path[0].arrow);
    const auto turning = [](const PairArrow<double, 2>& g, const Vector<double, 2>& p) {
      return g.target(0) * p(1) - g.target(1) * p(0);
    };
    for (std::size_t k = 0; k < steps; ++k) {
      const double h = path.times[k + 1] - path.times[k];
      const double nu = path.step_multipliers[k];
      largest = std::max(largest, std::abs(nu));
      mean += nu * h;
      off = std::max(off, std::abs(h - epsilon * system.time_scale(path.path[k].arrow)));
      off = std::max(off, std::abs(nu - discrete_energy(system, path.path[k], 0, h) + path.energy));
      unequal = std::max(unequal, std::abs(h / system.h - 1));
      drift = std::max(drift, std::abs(turning(path.path[k].arrow, path.momenta[k + 1]) -
                                       turning(path.path[0].arrow, path.momenta[1])));
    }
    multipliers.push_back(largest);
    EXPECT_NEAR(path.times.back(), 2, 1e-13);
    EXPECT_LT(off, 1e-11);
    EXPECT_LT(std::abs(mean), 1e-10);
    EXPECT_LT(drift, 1e-12);
    EXPECT_GT(unequal, 0.1);
  }
  EXPECT_NEAR(std::log2((costs[0] - costs[1]) / (costs[1] - costs[2])), 2, 0.1);
  EXPECT_NEAR(std::log2(multipliers[0] / multipliers[1]), 2, 0.3);
  EXPECT_LT(multipliers[2], 1e-2);
}

}  // namespace
}  // namespace free_steps_motions_tests
