// Newton, shooting and Ceres on the same boundary values.
#include <lagroid/solvers/boundary/boundary_shooting.hpp>
#include <lagroid/solvers/boundary/boundary_values.hpp>

#include "boundary_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace lagroid;

namespace boundary_boundary_methods_tests {
namespace {

/// All three methods find the known trajectory among their solutions, and agree on its cost.
template <class Sys> void expect_found_by_all(const Known<Sys>& k, int starts) {
  const Sys& system = k.problem.system;
  const double cost = action(system, k.path);
  const auto momentum = tangent_momentum(system, k.start);
  for (const auto method : {BoundaryMethod::newton, BoundaryMethod::shooting, BoundaryMethod::ceres}) {
    MultistartOptions options;
    options.starts = starts;
    const auto found = solve_boundary(*make_boundary_solver<Sys>(method), k.problem, k.path.size(), options);
    const bool met = std::any_of(found.solutions.begin(), found.solutions.end(), [&](const auto& s) {
      const auto mu = tangent_momentum(system, legendre_minus(system, s.path.front()));
      return std::abs(s.cost - cost) < 1e-9 * (1 + std::abs(cost)) && (mu - momentum).norm() < 1e-8 &&
             s.residual < 1e-11;
    });
    EXPECT_TRUE(met) << "method " << int(method);
  }
}

TEST(EveryMethod, Pendulum) {
  expect_found_by_all(known(pendulum(), {Vector<double, 1>(0.4), Vector<double, 1>(0.9)}, 40), 4);
}
TEST(EveryMethod, ObjectConstraints) {
  expect_found_by_all(known(spherical_pendulum(), {{0.6, 0, -0.8}, {0.2, 0.9, 0.15}}, 40), 6);
}

TEST(EveryMethod, PlateBallFromAWarmStart) {
  const PlateBall system = plate_ball(30);
  const BoundaryProblem<PlateBall> problem{system, plate_ball_ends()};
  const auto newton = make_boundary_solver<PlateBall>()->solve(problem, straight(system, 30), false);
  ASSERT_TRUE(newton.converged());
  // Away from it, and back.
  auto path = newton.path;
  for (auto& step : path) step.multipliers *= 1.001;
  const auto shooting = make_boundary_solver<PlateBall>(BoundaryMethod::shooting)->solve(problem, path, true);
  ASSERT_TRUE(shooting.converged()) << shooting.residual;
  EXPECT_GT(shooting.iterations, 1);
  EXPECT_NEAR(shooting.cost, newton.cost, 1e-10 * newton.cost);
  EXPECT_LT((initial_momentum(system, shooting.path) - initial_momentum(system, newton.path)).norm(), 1e-8);
  EXPECT_TRUE(shooting.kind.is_minimum);
  const auto ceres = make_boundary_solver<PlateBall>(BoundaryMethod::ceres)->solve(problem, path, true);
  ASSERT_TRUE(ceres.converged()) << ceres.residual;
  EXPECT_NEAR(ceres.cost, newton.cost, 1e-10 * newton.cost);
}

TEST(Shooting, SensitivityIsTheDerivativeOfTheEnd) {
  const PlateBall system = plate_ball(30);
  State<PlateBall::GroupoidType> start;
  std::get<0>(start.object) << 0.2, -0.1;
  start.momentum << 0.9, 0.2, 0.6, -0.4, 0.8;
  const auto middle = known(system, start, 30);
  const auto sensitivity = end_sensitivity(system, middle.path);
  const auto& groupoid = system.groupoid;
  const auto back = groupoid.inverse(middle.problem.boundary);
  const double e = 1e-6;
  for (int j = 0; j < 5; ++j) {
    auto plus = start;
    plus.momentum(j) += e;
    auto minus = start;
    minus.momentum(j) -= e;
    const Vector<double, 5> difference =
        (groupoid.tau_inverse(groupoid.compose(back, known(system, plus, 30).problem.boundary)) -
         groupoid.tau_inverse(groupoid.compose(back, known(system, minus, 30).problem.boundary))) /
        (2 * e);
    EXPECT_LT((difference - sensitivity.col(j)).norm(), 1e-7 * (1 + difference.norm())) << j;
  }
}

TEST(Shooting, AnEndOutOfReachIsATypedFailure) {
  // The trace form's steps turn by less than pi/2: this end cannot be reached.
  PlateBall system = plate_ball(3);
  system.rotation = RotationForm::trace;
  const BoundaryProblem<PlateBall> problem{system,
                                           {PairArrow<double, 2>{{0, 0}, {100, 0}}, Matrix<double, 3, 3>::Identity()}};
  const auto out =
      make_boundary_solver<PlateBall>(BoundaryMethod::shooting)->solve(problem, geodesic_path(problem, 3), true);
  EXPECT_EQ(out.status, SolveStatus::not_converged);
  EXPECT_FALSE(out.path.empty());
  EXPECT_EQ(out.message.rfind("shooting: the end is still missed by ", 0), 0U) << out.message;
}

TEST(Shooting, SaysWhatItsIterationLimitLeft) {
  const PlateBall system = plate_ball(30);
  const BoundaryProblem<PlateBall> problem{system, plate_ball_ends()};
  auto path = make_boundary_solver<PlateBall>()->solve(problem, straight(system, 30), false).path;
  for (auto& step : path) step.multipliers *= 1.1;
  BoundaryOptions options;
  options.max_iterations = 1;
  const auto out = make_boundary_solver<PlateBall>(BoundaryMethod::shooting, options)->solve(problem, path, true);
  EXPECT_EQ(out.status, SolveStatus::not_converged);
  EXPECT_NE(out.message.find("after 1 iterations"), std::string::npos) << out.message;
}

TEST(Ceres, ItsIterationLimitIsNoStall) {
  const PlateBall system = plate_ball(30);
  const BoundaryProblem<PlateBall> problem{system, plate_ball_ends()};
  BoundaryOptions options;
  options.max_iterations = 2;
  const auto solver = make_boundary_solver<PlateBall>(BoundaryMethod::ceres, options);
  const auto out = solver->solve(problem, straight(system, 30), true);
  EXPECT_EQ(out.status, SolveStatus::not_converged);
  EXPECT_TRUE(std::isfinite(out.residual));
  EXPECT_NE(out.message.find("solver.method = \"newton\""), std::string::npos) << out.message;
}

TEST(EveryMethod, RefusesAPathThatIsNoPathOfTheProblem) {
  const auto k = known(pendulum(), {Vector<double, 1>(0.4), Vector<double, 1>(0.9)}, 8);
  auto torn = k.path;
  torn[3].arrow.source(0) += 0.1;
  auto elsewhere = k.problem;
  elsewhere.boundary.target(0) += 0.1;
  auto not_finite = k.path;
  not_finite[1].arrow.source(0) = not_finite[0].arrow.target(0) = std::nan("");
  for (const auto method : {BoundaryMethod::newton, BoundaryMethod::shooting, BoundaryMethod::ceres}) {
    const auto solver = make_boundary_solver<Pendulum>(method);
    EXPECT_THROW(solver->solve(k.problem, {}, true), std::invalid_argument);
    EXPECT_THROW(solver->solve(k.problem, torn, true), std::invalid_argument);
    EXPECT_THROW(solver->solve(elsewhere, k.path, true), std::invalid_argument);
    EXPECT_TRUE(solver->solve(k.problem, k.path, true).converged());
    EXPECT_EQ(solver->solve(k.problem, not_finite, true).status, SolveStatus::not_finite) << int(method);
  }
}

TEST(EveryMethod, RefusesAPathWithAnotherProductOnAGroup) {
  // All rotations compose; what is wrong shows in their product alone.
  State<SO3> start;
  start.momentum << 0.3, 1.5, 0.4;
  auto k = known(rigid_body(), start, 8);
  const auto solver = make_boundary_solver<RigidBody>();
  EXPECT_TRUE(solver->solve(k.problem, k.path, true).converged());
  k.problem.boundary = k.problem.boundary * SO3::exp(Vector<double, 3>(0, 0, 0.1));
  EXPECT_THROW(solver->solve(k.problem, k.path, true), std::invalid_argument);
}

TEST(EveryMethod, LeavesOutTheKindWhereItIsNotAskedFor) {
  // A motion past a conjugate point is no minimum; unasked, nobody says so.
  const auto k = known(pendulum(), {Vector<double, 1>(0.05), Vector<double, 1>(0.1)}, 90);
  BoundaryOptions options;
  options.classify = false;
  for (const auto method : {BoundaryMethod::newton, BoundaryMethod::shooting, BoundaryMethod::ceres}) {
    const auto with = make_boundary_solver<Pendulum>(method)->solve(k.problem, k.path, true);
    const auto without = make_boundary_solver<Pendulum>(method, options)->solve(k.problem, k.path, true);
    ASSERT_TRUE(with.converged() && without.converged()) << int(method);
    EXPECT_EQ(with.kind.negative_directions, 1) << int(method);
    EXPECT_EQ(without.kind.negative_directions, 0) << int(method);
    EXPECT_EQ(with.cost, without.cost) << int(method);
  }
}

TEST(Ceres, ItsStallIsTypedAndExplained) {
  // Normal equations square the condition number: on a path this long Ceres does not reach the tolerance, Newton does.
  const std::size_t steps = 50000;
  Pendulum system;
  system.h = 2 / double(steps);
  const BoundaryProblem<Pendulum> problem{system, {Vector<double, 1>(0.3), Vector<double, 1>(1.2)}};
  const Path<Pendulum> path = geodesic_path(problem, steps);
  BoundaryOptions options;
  options.max_iterations = 60;
  const auto ceres = make_boundary_solver<Pendulum>(BoundaryMethod::ceres, options)->solve(problem, path, false);
  EXPECT_EQ(ceres.status, SolveStatus::ill_conditioned) << ceres.residual;
  EXPECT_NE(ceres.message.find("solver.method = \"newton\""), std::string::npos);
  const auto newton = make_boundary_solver<Pendulum>(BoundaryMethod::newton, options)->solve(problem, path, false);
  EXPECT_TRUE(newton.converged());
  EXPECT_LE(newton.residual, 1e-10);
}

}  // namespace
}  // namespace boundary_boundary_methods_tests
