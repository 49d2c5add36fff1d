// Too long for every test run: millions of steps, and boundary values over many seeds.
#include "../../support/nonholonomic_runs.hpp"
#include "../../support/run_watch.hpp"

#include <lagroid/groupoids/groups/rotation_fibre.hpp>
#include <lagroid/solvers/boundary/boundary_newton.hpp>
#include <lagroid/solvers/step/arclength.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/control/plate_ball_boundary.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/newton_examples.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace integrators_nightly_runs_tests {
namespace {

TEST(Nightly, MillionsOfSteps) {
  RigidBody body;
  body.h = 0.05;
  State<SO3> m;
  m.momentum << 0.3, 1.5, 0.4;
  const auto rigid = watch(body, m, 5'000'000);
  ASSERT_FALSE(rigid.empty());
  EXPECT_LT(rigid.at("spatial momentum A M").drift, 1e-11);
  EXPECT_LT(rigid.at("energy").last_quarter, 1.05 * rigid.at("energy").first_quarter);

  Kepler kepler;
  kepler.quadrature = Quadrature::midpoint;
  kepler.h = 0.01;
  const auto orbit = watch(kepler, {{0.4, 0}, {0, 2}}, 5'000'000);
  ASSERT_FALSE(orbit.empty());
  EXPECT_LT(orbit.at("angular momentum").drift, 1e-11);
  EXPECT_LT(orbit.at("energy").last_quarter, 1.1 * orbit.at("energy").first_quarter);

  SphericalPendulum pendulum;
  pendulum.h = 0.02;
  const auto swing = watch(pendulum, {{0.6, 0, -0.8}, {0, 0.9, 0}}, 2'000'000);
  ASSERT_FALSE(swing.empty());
  EXPECT_LT(swing.at("vertical angular momentum").drift, 1e-11);
  EXPECT_LT(swing.at("energy").last_quarter, 1.1 * swing.at("energy").first_quarter);

  PlateBall plate;
  plate.h = 0.05;
  plate.spin = 0.4;
  State<PlateBall::GroupoidType> s;
  std::get<0>(s.object) << 0.3, -0.2;
  s.momentum << 0.9, 0.2, 0.6, -0.4, 0.8;
  const auto ball = watch(plate, s, 1'000'000);
  ASSERT_FALSE(ball.empty());
  EXPECT_LT(ball.at("spatial momentum A M").drift, 1e-11);
}

TEST(Nightly, NonholonomicSystemsOverAMillionSteps) { expect_no_drift(1'000'000, 1e-11); }

TEST(Nightly, PathsReachEveryStepOnOrthogonalGroupsUpTo15) {
  int cells = 0;
  int solved = 0;
  for (const auto which : {NewtonExample::first, NewtonExample::second})
    for (Eigen::Index n = 2; n <= 15; ++n)
      for (std::uint64_t seed = 1000; seed < 1004; ++seed) {
        const RotationFibre fibre(random_orthogonal(n, seed));
        const ExampleField field(which);
        SolutionPath<RotationFibre<>, ExampleField<>> path(fibre, field);
        for (int log2h = -10; log2h <= 10; ++log2h) {
          const double h = std::ldexp(1.0, log2h);
          const auto found = path.reach(h);
          const ImplicitStep step{fibre, field, h};
          ++cells;
          solved += found.converged() && step.norm(step.residual(fibre.at(found.v), found.v)) <= 2e-13 * (1 + h);
        }
      }
  EXPECT_GE(solved, 0.99 * cells);
}

TEST(Nightly, EverySeedFindsTheBestMinimum) {
  for (const double rate : {0.0, 1.0, 5.0}) {
    PlateBall system;
    system.plate_rate = rate;
    system.spin = rate == 0 ? 0 : 0.5;
    system.rotation = RotationForm::exponential;
    system.h = 1.0 / 30;
    const ArrowOf<PlateBall::GroupoidType> ends{PairArrow<double, 2>{{0.2, -0.1}, {1, 0.5}},
                                                SO3::exp(Vector<double, 3>(0.6, -0.3, 0.9))};
    double best = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      PlateBallBoundaryOptions options;
      options.steps = 30;
      options.seed = seed;
      const auto found = solve_plate_ball(*make_boundary_solver<PlateBall>(), system, ends, options);
      ASSERT_FALSE(found.solutions.empty());
      if (seed == 1) best = found.solutions.front().cost;
      EXPECT_NEAR(found.solutions.front().cost, best, 1e-9 * best) << rate << ' ' << seed;
      EXPECT_GE(found.outcomes.at(SolveStatus::converged), options.starts - 6) << rate << ' ' << seed;
    }
  }
}

}  // namespace
}  // namespace integrators_nightly_runs_tests
