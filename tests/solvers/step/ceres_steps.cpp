// Ceres gives back what it has solved, whatever it says of itself, and says nothing on standard error.
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/groupoids/trivial.hpp>
#include <lagroid/solvers/ceres_solve.hpp>
#include <lagroid/solvers/newton/ceres_manifold.hpp>
#include <lagroid/solvers/step/step_methods.hpp>
#include <lagroid/solvers/testing/solver_laws.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include "../../support/affine.hpp"
#include "../../support/hasty_solver.hpp"
#include "groupoid_motion.hpp"

#include <ceres/cost_function.h>
#include <glog/logging.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace lagroid;

namespace step_ceres_steps_tests {
namespace {

template <class G> class Manifold : public ::testing::Test {};
using Groupoids =
    ::testing::Types<Affine, SpecialOrthogonal3<Retraction::cayley>, SE3, Trivial<2, SO3>, Action<SO3, RotatedVectors>>;
TYPED_TEST_SUITE(Manifold, Groupoids);

/// Arrows as they are met in a run: not on the groupoid to the last digit.
TYPED_TEST(Manifold, WhatIsNotMovedStaysToTheBit) {
  using G = TypeParam;
  const G groupoid;
  SourceFibreManifold<G> manifold(groupoid);
  using V = AlgebroidVector<G>;
  for (int i = 0; i < 1000; ++i) {
    const auto q = groupoid.template object_at<double>(
        Vector<double, G::object_coordinate_count()>(Vector<double, G::object_coordinate_count()>::Random()));
    const auto g = groupoid.tau(q, V(V::Random()));
    const auto far = groupoid.compose(g, groupoid.tau(groupoid.target(g), V(V::Random())));
    typename SourceFibreManifold<G>::Ambient x = groupoid.coordinates_of_arrow(far);
    auto y = x;
    const V rest = V::Constant(i % 2 == 0 ? 0.0 : -0.0);
    ASSERT_TRUE(manifold.Plus(x.data(), rest.data(), y.data()));
    EXPECT_EQ(x, y);
    const V by = V::Random();
    ASSERT_TRUE(manifold.Plus(x.data(), by.data(), y.data()));
    V back;
    ASSERT_TRUE(manifold.Minus(y.data(), x.data(), back.data()));
    EXPECT_LT((back - by).norm(), 1e-12);
  }
}

/// x^3 = 1, whose derivative is not to be had near the solution: Ceres ends there by a failure.
class Cube final : public ceres::CostFunction {
 public:
  Cube() {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(1);
  }
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    residuals[0] = x[0][0] * x[0][0] * x[0][0] - 1;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    jacobians[0][0] = 3 * x[0][0] * x[0][0];
    return std::abs(residuals[0]) > 0.1;
  }
};

TEST(SolveByCeres, LeavesTheBestPointAfterAFailure) {
  double x = 3;
  ceres::Problem problem;
  problem.AddResidualBlock(new Cube, nullptr, &x);
  auto options = lagroid::detail::to_round_off(100);
  options.linear_solver_type = ceres::DENSE_QR;
  const int level = FLAGS_minloglevel;
  ::testing::internal::CaptureStderr();
  const auto summary = lagroid::detail::solve_by_ceres(options, problem);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(FLAGS_minloglevel, level);
  ASSERT_EQ(summary.termination_type, ceres::FAILURE);
  ASSERT_GT(summary.iterations.size(), 2u);
  EXPECT_NEAR(0.5 * std::pow(x * x * x - 1, 2), summary.final_cost, 1e-15);
  EXPECT_LT(x, 1.5);
}

/// The heavy top of examples/heavy_top.toml.
State<HeavyTop::GroupoidType> leaning() {
  const Matrix<double, 3, 3> attitude = SO3::from_quaternion({0.9537169507482269, 0.3007057995042731, 0, 0});
  return {attitude.transpose() * Vector<double, 3>::UnitZ(), {0, 0, 2.5}};
}

/// Ceres used to call failures steps that it had solved to the last bit.
TEST(CeresStep, SolvesTheStepsOfAHeavyTop) {
  for (const double h : {0.02, 0.01}) {
    HeavyTop top;
    top.h = h;
    const auto start = leaning();
    FixedStepIntegrator<HeavyTop> integrator(top, start, top.groupoid.unit(start.object),
                                             make_step_solver(top, StepMethod::ceres));
    ::testing::internal::CaptureStderr();
    for (int k = 0; k < 2000; ++k) {
      const auto report = integrator.advance();
      EXPECT_TRUE(report.converged()) << h << ": step " << k + 1 << ' ' << to_string(report.status);
    }
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  }
}

State<Pair<2>> draw_orbit() { return {{1, 0.2 * laws::draw_uniform()}, {0.1 * laws::draw_uniform(), 1}}; }

TEST(CeresStep, SolvesWhatNewtonSolves) {
  constexpr int steps = 100;
  const auto expect = [](const auto& report) { EXPECT_TRUE(report.holds()) << report; };
  expect(laws::solver_laws(Kepler{}, draw_orbit, StepMethod::ceres, steps));
  PlateBall ball;
  ball.plate_rate = 0.7;
  ball.spin = 0.4;
  expect(laws::solver_laws(
      ball,
      [] {
        State<PlateBall::GroupoidType> s;
        std::get<0>(s.object) = laws::draw_vector<2>(1.0);
        for (double& x : s.momentum) x = laws::draw_uniform();
        return s;
      },
      StepMethod::ceres, steps));
  expect(laws::solver_laws(
      SphericalPendulum{},
      [] {
        const Vector<double, 3> q = (laws::draw_vector<3>(0.5) - Vector<double, 3>::UnitZ()).normalized();
        return State<Pair<3>>{q, q.cross(Vector<double, 3>(0.3, 0.5, laws::draw_uniform()))};
      },
      StepMethod::ceres, steps));
  RollingBall rolling;
  rolling.plate_rate = 1.3;
  expect(laws::solver_laws(
      rolling,
      [&] { return rolling.rolling(laws::draw_vector<2>(1.0), laws::draw_vector<2>(1.0), laws::draw_uniform()); },
      StepMethod::ceres, steps));
}

/// A system of a user's own.
TEST(CeresStep, SolvesTheStepsOfOnesOwnSystem) {
  const Motion<Affine> system;
  const auto report = laws::solver_laws(
      system, [&] { return draw_motion(system.groupoid, ObjectOf<Affine>::Zero().eval(), 0.5); }, StepMethod::ceres,
      100);
  EXPECT_TRUE(report.holds()) << report;
}

/// Newton's solver that gives up steps it has solved, as Ceres did.
class GivesUp final : public StepSolver<Kepler> {
 public:
  StepReport solve(const Kepler& system, const State<Pair<2>>& state, StepSolution<Kepler>& solution) override {
    StepReport report = newton_.solve(system, state, solution);
    if (++solves_ > 60) report.status = SolveStatus::stagnated;
    return report;
  }

 private:
  NewtonStep<Kepler> newton_;
  int solves_ = 0;
};
TEST(BrokenSolver, ThatThrowsAwayWhatItHasSolved) {
  const auto report = laws::solver_laws(
      Kepler{}, draw_orbit, [] { return std::make_unique<GivesUp>(); }, 100);
  const auto& law = report.law("steps are solved as by Newton");
  EXPECT_FALSE(law.holds()) << report;
  EXPECT_NE(law.first_failure.find("stagnated"), std::string::npos) << report;
}

/// Stops early.
TEST(BrokenSolver, ThatDoesNotGoOnToTheEnd) {
  Kepler system;
  system.h = 0.2;
  system.quadrature = Quadrature::midpoint;  // an implicit step
  const auto report = laws::solver_laws(
      system, draw_orbit, [] { return std::make_unique<Hasty<Kepler>>(); }, 100);
  EXPECT_FALSE(report.holds()) << report;
}

}  // namespace
}  // namespace step_ceres_steps_tests
