// Steps that are a function of their arrow ([G], after Example 6.2), as initial values: of Kepler's orbits, of a system
// of one's own with a constraint on objects, and where there is no such function.
#include <lagroid/core/capabilities/discrete_energy.hpp>
#include <lagroid/solvers/integrators/integrator_methods.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>

#include "../../../support/allocation_counter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace lagroid;

namespace prescribed_orbits_tests {
namespace {

constexpr double eccentricity = 0.8;

Kepler orbit(double h) {
  Kepler system;
  system.h = h;
  return system;
}
State<Pair<2>> perihelion() { return {{1 - eccentricity, 0}, {0, std::sqrt((1 + eccentricity) / (1 - eccentricity))}}; }

template <class Sys>
PrescribedIntegrator<Sys> prescribed(const Sys& system, const State<typename Sys::GroupoidType>& s) {
  return {system, s, system.groupoid.unit(s.object), std::make_unique<NewtonStep<Sys>>(),
          std::make_unique<NewtonStep<PrescribedStep<Sys, TimeScaleStep>>>()};
}

/// A bead on a circle that is drawn to a point near it, in Cartesian coordinates.
struct Bead : System<Bead, Pair<2>, /*arrow constraints*/ 0, /*object constraints*/ 1> {
  double h = 0.02;
  template <class S> S distance(const Vector<S, 2>& q) const {
    using std::sqrt;
    const Vector<S, 2> off(q(0) - 1.2, q(1));
    return sqrt(off.squaredNorm());
  }
  template <class S, class H> S lagrangian(const PairArrow<S, 2>& g, const H& step) const {
    return (g.target - g.source).squaredNorm() / (step * 2.0) +
           (S(1.0) / distance(g.source) + S(1.0) / distance(g.target)) * step * 0.5;
  }
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const { return lagrangian(g, h); }
  template <class S> Vector<S, 1> object_constraint(const Vector<S, 2>& q) const {
    return Vector<S, 1>((q.squaredNorm() - 1.0) * 0.5);
  }
  template <class S> S time_scale(const PairArrow<S, 2>& g) const {
    using std::sqrt;
    const S d = distance(Vector<S, 2>((g.source + g.target) * 0.5));
    return d * sqrt(d);
  }
};

TEST(Prescribed, StepsAreThatFunctionOfTheArrow) {
  const Kepler system = orbit(0.004);
  auto run = prescribed(system, perihelion());
  double epsilon = 0;
  double shortest = 1;
  double longest = 0;
  for (int k = 0; k < 400; ++k) {
    ASSERT_TRUE(run.advance().converged()) << k;
    const double size = run.point().step_size;
    const double ratio = size / system.time_scale(run.point().step.arrow);
    if (k == 0) {
      epsilon = ratio;
      EXPECT_EQ(size, system.h);
    }
    EXPECT_NEAR(ratio / epsilon, 1, 1e-12) << k;
    shortest = std::min(shortest, size);
    longest = std::max(longest, size);
  }
  EXPECT_GT(longest / shortest, 20) << "the orbit's two ends";
}

/// What E_d of the last arrow differs by from p_t, less its multiplier.
template <class Sys> double off_the_balance(const Sys& system, const PrescribedIntegrator<Sys>& run) {
  const auto& point = run.point();
  const double energy = discrete_energy(system, point.step, point.time - point.step_size, point.step_size);
  return std::abs(run.step_multiplier() - energy - run.momentum_of_time());
}

template <class Sys> void expect_kept_and_back(const Sys& system, const State<Pair<2>>& start, int steps) {
  auto run = prescribed(system, start);
  ASSERT_TRUE(run.advance().converged());
  const double first = run.momentum_of_time();
  double largest = 0;
  for (int k = 1; k < steps; ++k) {
    ASSERT_TRUE(run.advance().converged()) << k;
    EXPECT_NEAR(run.momentum_of_time(), first, 1e-13 * std::abs(first)) << k;
    EXPECT_LT(off_the_balance(system, run), 1e-11) << k;
    largest = std::max(largest, std::abs(run.step_multiplier()));
  }
  EXPECT_GT(largest, 1e-9) << "the energy is not what it keeps";
  // The same arrows back: p_t goes with the first step, so it is the extended system that is turned round.
  const PrescribedStep<Sys, TimeScaleStep> extended(
      system, TimeScaleStep{run.point().step_size / system.time_scale(run.point().step.arrow)});
  using Extended = PrescribedStep<Sys, TimeScaleStep>;
  State<typename Extended::GroupoidType> turned;
  turned.object = {Vector<double, 1>(0.0), run.point().state.object};
  turned.momentum << run.momentum_of_time(), -run.point().state.momentum;
  FixedStepIntegrator<Extended> back(extended, turned, extended.groupoid.unit(turned.object),
                                     std::make_unique<NewtonStep<Extended>>());
  for (int k = 0; k < steps; ++k) ASSERT_TRUE(back.advance().converged()) << k;
  EXPECT_LT((std::get<1>(back.point().state.object) - start.object).norm(), 1e-10);
}
TEST(Prescribed, KeepTheMomentumOfTimeAndReturn) { expect_kept_and_back(orbit(0.01), perihelion(), 300); }

TEST(Prescribed, KeepTheMomentumOfTimeOnAConstraint) {
  const Bead bead;
  const State<Pair<2>> start{{0, 1}, {-1.5, 0}};
  expect_kept_and_back(bead, start, 200);
}

/// The distance from the true orbit at the end of one revolution or soon after it.
double error_of(Integrator<Kepler>& run, long& steps) {
  steps = 0;
  while (run.point().time < 2 * std::numbers::pi) {
    const bool is_solved = run.advance().converged();
    EXPECT_TRUE(is_solved);
    if (!is_solved) return std::numeric_limits<double>::infinity();
    ++steps;
  }
  const double time = run.point().time;
  double anomaly = time;  // Kepler's equation
  for (int k = 0; k < 50; ++k)
    anomaly -= (anomaly - eccentricity * std::sin(anomaly) - time) / (1 - eccentricity * std::cos(anomaly));
  const Vector<double, 2> exact(std::cos(anomaly) - eccentricity,
                                std::sqrt(1 - eccentricity * eccentricity) * std::sin(anomaly));
  return (run.point().state.object - exact).norm();
}
double error_by(TimeMode mode, double h, long& steps) {
  auto run = make_integrator(orbit(h), perihelion(), Pair<2>::unit(perihelion().object), {.mode = mode});
  return error_of(*run, steps);
}

TEST(Prescribed, AreOfOrderTwo) {
  long steps = 0;
  const double coarse = error_by(TimeMode::prescribed, 0.002, steps);
  const double fine = error_by(TimeMode::prescribed, 0.001, steps);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

TEST(Prescribed, BeatEqualStepsOnAnEccentricOrbit) {
  long steps = 0;
  const double error = error_by(TimeMode::prescribed, 0.002, steps);
  long equal_steps = 0;
  const double equal = error_by(TimeMode::fixed, 2 * std::numbers::pi / double(steps), equal_steps);
  EXPECT_NEAR(double(equal_steps), double(steps), 1.5);
  EXPECT_LT(5 * error, equal);
}

// The last iterations of a step may go round at round-off, where the norm of the residual and its share of what
// rounding leaves fall in turn: about half of these runs ended there.
TEST(Prescribed, AreSolvedAtEveryStepSize) {
  int failed = 0;
  for (double h = 0.001; h < 0.004; h *= 1.02) {
    auto run = prescribed(orbit(h), perihelion());
    int steps = 0;
    while (steps < 1500 && run.advance().converged()) ++steps;
    failed += steps < 1500;
  }
  EXPECT_EQ(failed, 0);
}

// Steps so long that none of the solutions of their equations is of the motion: one led out to |q| = 1000.
TEST(Prescribed, EndWhereTheSizeOfAStepJumps) {
  const State<Pair<2>> start{{0.1, 0}, {0, std::sqrt(19.0)}};
  auto run = prescribed(orbit(0.02), start);
  StepReport report = run.advance();
  double last = run.point().step_size;
  while (report.converged() && run.point().index < 10) {
    report = run.advance();
    EXPECT_LE(run.point().step_size, 2 * last);
    last = run.point().step_size;
  }
  EXPECT_EQ(report.status, SolveStatus::left_domain);
  const State<Pair<2>> before = run.point().state;
  EXPECT_EQ(run.advance().status, SolveStatus::left_domain);
  EXPECT_EQ(run.point().state.object, before.object);
}

TEST(Prescribed, SaySoWithoutATimeScale) {
  const Pendulum pendulum;
  const State<Pair<1>> start{Vector<double, 1>(1), Vector<double, 1>(0)};
  try {
    make_integrator(pendulum, start, Pair<1>::unit(start.object), {.mode = TimeMode::prescribed});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("time_scale(g)"), std::string::npos) << error.what();
  }
}

TEST(Prescribed, AllocateNothing) {
  auto run = prescribed(orbit(0.01), perihelion());
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(run.advance().converged());
  const auto before = allocation_count();
  for (int k = 0; k < 50; ++k) ASSERT_TRUE(run.advance().converged());
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace prescribed_orbits_tests
