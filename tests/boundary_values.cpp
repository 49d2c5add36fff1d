// Boundary values of any system: three methods, object constraints, work linear in N, continuation, honest failures.
#include <lagroid/solvers/boundary_ceres.hpp>
#include <lagroid/solvers/boundary_newton.hpp>
#include <lagroid/solvers/boundary_shooting.hpp>
#include <lagroid/solvers/boundary_values.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulum.hpp>
#include <lagroid/systems/plate_ball.hpp>
#include <lagroid/systems/rigid_body.hpp>
#include <lagroid/systems/spherical_pendulum.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace lagroid;

namespace {

/// A problem whose answer is known: the ends of a trajectory of the integrator.
template <class Sys> struct Known {
  BoundaryProblem<Sys> problem;
  State<typename Sys::GroupoidType> start;
  Path<Sys> path;
};

template <class Sys>
Known<Sys> known(const Sys& system, const State<typename Sys::GroupoidType>& start, std::size_t steps) {
  const auto unit = system.groupoid.unit(start.object);
  Integrator<Sys> integrator(system, start, unit, std::make_unique<NewtonStep<Sys>>());
  Known<Sys> out{{system, unit}, start, {}};
  for (std::size_t k = 0; k < steps; ++k) {
    EXPECT_TRUE(integrator.advance().converged());
    out.path.push_back(integrator.point().step);
  }
  out.problem.boundary = integrator.point().configuration;
  return out;
}

/// All three methods find the known trajectory among their solutions, and agree on its cost.
template <class Sys> void expect_found_by_all(const Known<Sys>& k, int starts) {
  const Sys& system = k.problem.system;
  const double cost = action(system, k.path);
  const auto momentum = tangent_momentum(system, k.start);
  std::vector<std::unique_ptr<BoundarySolver<Sys>>> solvers;
  solvers.push_back(std::make_unique<BoundaryNewton<Sys>>());
  solvers.push_back(std::make_unique<BoundaryShooting<Sys>>());
  solvers.push_back(std::make_unique<BoundaryCeres<Sys>>());
  for (std::size_t i = 0; i < solvers.size(); ++i) {
    MultistartOptions options;
    options.starts = starts;
    const auto found = solve_boundary(*solvers[i], k.problem, k.path.size(), options);
    const bool met = std::any_of(found.solutions.begin(), found.solutions.end(), [&](const auto& s) {
      const auto mu = tangent_momentum(system, legendre_minus(system, s.path.front()));
      return std::abs(s.cost - cost) < 1e-9 * (1 + std::abs(cost)) && (mu - momentum).norm() < 1e-8 &&
             s.residual < 1e-11;
    });
    EXPECT_TRUE(met) << "method " << i;
  }
}

Pendulum pendulum() {
  Pendulum system;
  system.h = 0.05;
  return system;
}
Kepler kepler() {
  Kepler system;
  system.h = 0.02;
  return system;
}
RigidBody rigid_body() {
  RigidBody system;
  system.h = 0.04;
  return system;
}
SphericalPendulum spherical_pendulum() {
  SphericalPendulum system;
  system.h = 0.03;
  return system;
}

TEST(EveryMethod, Pendulum) {
  expect_found_by_all(known(pendulum(), {Vector<double, 1>(0.4), Vector<double, 1>(0.9)}, 40), 4);
}
TEST(EveryMethod, KeplerIsLambertsProblem) { expect_found_by_all(known(kepler(), {{1, 0}, {0.1, 0.9}}, 80), 12); }
TEST(EveryMethod, RigidBody) { expect_found_by_all(known(rigid_body(), {{}, {0.5, 0.6, -0.7}}, 40), 3); }
TEST(EveryMethod, ObjectConstraints) {
  expect_found_by_all(known(spherical_pendulum(), {{0.6, 0, -0.8}, {0.2, 0.9, 0.15}}, 40), 6);
}

PlateBall plate_ball(std::size_t steps) {
  PlateBall system;
  system.h = 1 / double(steps);
  system.rotation = RotationForm::exponential;
  system.plate_rate = 1;
  system.spin = 0.5;
  return system;
}
ArrowOf<PlateBall::GroupoidType> plate_ball_ends() {
  return {PairArrow<double, 2>{{0.2, -0.1}, {1, 0.5}}, SO3::exp(Vector<double, 3>(0.6, -0.3, 0.9))};
}
Path<PlateBall> straight(const PlateBall& system, std::size_t steps) {
  Path<PlateBall> path;
  for (const auto& arrow : system.path(plate_ball_ends(), long(steps), Eigen::Matrix2Xd::Zero(2, 1)))
    path.push_back({arrow, PlateBall::Multipliers::Zero()});
  return path;
}

TEST(EveryMethod, PlateBallFromAWarmStart) {
  const PlateBall system = plate_ball(30);
  const BoundaryProblem<PlateBall> problem{system, plate_ball_ends()};
  const auto newton = BoundaryNewton<PlateBall>().solve(problem, straight(system, 30), false);
  ASSERT_TRUE(newton.converged());
  // Away from it, and back.
  auto path = newton.path;
  for (auto& step : path) step.multipliers *= 1.001;
  const auto shooting = BoundaryShooting<PlateBall>().solve(problem, path, true);
  ASSERT_TRUE(shooting.converged()) << shooting.residual;
  EXPECT_GT(shooting.iterations, 1);
  EXPECT_NEAR(shooting.cost, newton.cost, 1e-10 * newton.cost);
  EXPECT_LT((initial_momentum(system, shooting.path) - initial_momentum(system, newton.path)).norm(), 1e-8);
  EXPECT_TRUE(shooting.kind.is_minimum);
  const auto ceres = BoundaryCeres<PlateBall>().solve(problem, path, true);
  ASSERT_TRUE(ceres.converged()) << ceres.residual;
  EXPECT_NEAR(ceres.cost, newton.cost, 1e-10 * newton.cost);
}

/// Counts what a solve asks of the system.
struct Counted : PlateBall {
  static inline long lagrangians = 0;
  template <class S> S lagrangian(const Arrow<S>& g) const {
    ++lagrangians;
    return PlateBall::lagrangian(g);
  }
};

TEST(Work, IterationsDoNotGrowWithTheNumberOfArrows) {
  // From the straight line, to 1e-10: the work is linear in N because the iterations are as many.
  std::vector<int> iterations;
  std::vector<double> evaluations;
  for (const std::size_t steps : {100U, 1000U, 10000U}) {
    Counted system;
    static_cast<PlateBall&>(system) = plate_ball(steps);
    Path<Counted> path;
    for (const auto& step : straight(system, steps)) path.push_back({step.arrow, step.multipliers});
    Counted::lagrangians = 0;
    const auto solution = BoundaryNewton<Counted>().solve({system, plate_ball_ends()}, path, false);
    ASSERT_TRUE(solution.converged()) << steps;
    EXPECT_LE(solution.residual, 1e-10);
    EXPECT_TRUE(solution.kind.is_minimum);
    iterations.push_back(solution.iterations);
    evaluations.push_back(double(Counted::lagrangians) / double(steps));
  }
  for (std::size_t i = 1; i < iterations.size(); ++i) {
    EXPECT_LE(iterations[i], iterations[0] + 3);
    EXPECT_LE(evaluations[i], 1.3 * evaluations[0]);
  }
}

TEST(Work, AWarmStartTakesAFewIterationsWhateverN) {
  for (const std::size_t steps : {100U, 1000U, 10000U}) {
    PlateBall system = plate_ball(steps);
    const BoundaryProblem<PlateBall> problem{system, plate_ball_ends()};
    const auto first = BoundaryNewton<PlateBall>().solve(problem, straight(system, steps), false);
    system.plate_rate = 1.01;
    const auto next = BoundaryNewton<PlateBall>().solve({system, plate_ball_ends()}, first.path, true);
    ASSERT_TRUE(next.converged());
    EXPECT_LE(next.iterations, 6) << steps;
  }
}

TEST(Stationary, MotionsPastAConjugatePointAreFoundAndNamed) {
  // A pendulum near its equilibrium swings back after half a period: past that the action is no longer least.
  Pendulum system = pendulum();
  const std::size_t steps = 90;  // 4.5 s; the first conjugate point lies near pi
  const auto k = known(system, {Vector<double, 1>(0.05), Vector<double, 1>(0.1)}, steps);
  const BoundaryNewton<Pendulum> stationary;
  EXPECT_EQ(stationary.seek(), Seek::stationary);
  const auto found = stationary.solve(k.problem, geodesic_path(k.problem, steps), false);
  ASSERT_TRUE(found.converged());
  EXPECT_NEAR(found.cost, action(system, k.path), 1e-12);
  EXPECT_FALSE(found.kind.is_minimum);
  EXPECT_EQ(found.kind.negative_directions, 1);
}

TEST(Stationary, PathsStayOnTheObjectConstraint) {
  const SphericalPendulum system = spherical_pendulum();
  const auto k = known(system, {{0.6, 0, -0.8}, {0.2, 0.9, 0.15}}, 40);
  const auto found = BoundaryNewton<SphericalPendulum>().solve(k.problem, geodesic_path(k.problem, 40), false);
  ASSERT_TRUE(found.converged());
  for (std::size_t i = 0; i < found.path.size(); ++i) {
    EXPECT_LT(std::abs(system.object_constraint(found.path[i].arrow.target)(0)), 1e-12);
    EXPECT_LT((found.path[i].arrow.target - k.path[i].arrow.target).norm(), 1e-9) << i;
    if (i > 0) EXPECT_NEAR(found.path[i].multipliers(0), k.path[i].multipliers(0), 1e-9) << i;
  }
}

TEST(Stationary, EndsOffTheConstraintAreRefused) {
  const BoundaryProblem<SphericalPendulum> problem{spherical_pendulum(), {{0.6, 0, -0.8}, {0, 1.1, 0}}};
  ASSERT_TRUE(inadmissible_ends(problem).has_value());
  EXPECT_THROW(solve_boundary(BoundaryNewton<SphericalPendulum>(), problem, 20), std::invalid_argument);
}

/// Negative eigenvalues of the whole scaled KKT matrix, dense, against those its elimination counts.
template <class Sys> void expect_inertia(const Sys& system, const Path<Sys>& path) {
  using Kkt = BoundaryKkt<Sys>;
  Kkt kkt;
  kkt.evaluate(system, path);
  kkt.choose_scale();
  const int count = int(path.size());
  Eigen::MatrixXd dense(Kkt::size * count, Kkt::size * count);
  for (int column = 0; column < dense.cols(); ++column) {
    typename Kkt::Columns z(std::size_t(count), Kkt::Column::Zero());
    z[std::size_t(column / Kkt::size)](column % Kkt::size) = 1;
    const auto image = kkt.multiply(z);
    for (int k = 0; k < count; ++k) dense.block(Kkt::size * k, column, Kkt::size, 1) = image[std::size_t(k)];
  }
  EXPECT_LT((dense - dense.transpose()).norm(), 1e-13 * dense.norm());
  for (const double shift : {0.0, 0.3, -0.2}) {
    Eigen::MatrixXd shifted = dense;
    for (int k = 0; k < count; ++k)
      for (int i = 0; i < Sys::dimension; ++i)
        if (k + 1 < count) shifted(Kkt::size * k + Sys::constraints + i, Kkt::size * k + Sys::constraints + i) += shift;
    const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(shifted).eigenvalues();
    EXPECT_EQ(kkt.factor(shift, 0).negative, (eigenvalues.array() < 0).count()) << shift;
  }
}

TEST(Inertia, IsThatOfTheDenseMatrix) {
  const PlateBall system = plate_ball(8);
  Path<PlateBall> path = straight(system, 8);
  for (std::size_t k = 0; k < path.size(); ++k) path[k].multipliers << 3 - double(k), -2.0, 5.0 * std::sin(double(k));
  expect_inertia(system, path);
  const auto sphere = known(spherical_pendulum(), {{0.6, 0, -0.8}, {0.2, 0.9, 0.15}}, 60);
  expect_inertia(sphere.problem.system, sphere.path);
  const auto orbit = known(kepler(), {{1, 0}, {0.1, 0.9}}, 200);
  expect_inertia(orbit.problem.system, orbit.path);
}

TEST(SymmetricFactor, SolvesAndCountsWhereDiagonalsVanish) {
  std::srand(5);
  for (int trial = 0; trial < 200; ++trial) {
    SymmetricFactor<8>::Square a = SymmetricFactor<8>::Square::Random();
    a = (a + a.transpose()).eval();
    if (trial % 2 == 0) a.topLeftCorner<3, 3>().setZero();
    if (trial % 3 == 0) a.diagonal().setZero();
    SymmetricFactor<8> factor;
    factor.compute(a);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen{Eigen::MatrixXd(a)};
    EXPECT_EQ(factor.negative(), (eigen.eigenvalues().array() < 0).count());
    const Vector<double, 8> b = Vector<double, 8>::Random();
    const double condition = eigen.eigenvalues().cwiseAbs().maxCoeff() / eigen.eigenvalues().cwiseAbs().minCoeff();
    EXPECT_LT((a * factor.solve(b) - b).norm(), 1e-13 * condition);
    SymmetricFactor<8>::Square s = SymmetricFactor<8>::Square::Zero();
    const SymmetricFactor<8>::Square r = SymmetricFactor<8>::Square::Random();
    factor.subtract_from(s, r);
    const Eigen::MatrixXd expected = -r.transpose() * Eigen::MatrixXd(a).inverse() * r;
    EXPECT_LT((s - expected).norm(), 1e-12 * condition * (1 + expected.norm()));
  }
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
  const auto out = BoundaryShooting<PlateBall>().solve(problem, geodesic_path(problem, 3), true);
  EXPECT_FALSE(out.converged());
  EXPECT_FALSE(out.path.empty());
}

TEST(Continuation, CarriesASolutionAcrossAParameter) {
  const auto stage = [](double s) {
    PlateBall system = plate_ball(30);
    system.plate_rate = 3 * s;
    return BoundaryStage<PlateBall>{{system, plate_ball_ends()}, 30};
  };
  const BoundaryNewton<PlateBall> solver;
  const auto start = solver.solve(stage(0).problem, straight(stage(0).problem.system, 30), false);
  ASSERT_TRUE(start.converged());
  const auto end = follow(solver, stage, start);
  ASSERT_TRUE(end.converged());
  EXPECT_EQ(end.reached, 1);
  const auto again = solver.solve(stage(1).problem, end.solution.path, true);
  EXPECT_NEAR(again.cost, end.solution.cost, 1e-12 * again.cost);
  EXPECT_TRUE(end.solution.kind.is_minimum);
}

TEST(Continuation, MovesBothEndsAndChangesTheNumberOfArrows) {
  const auto k = known(kepler(), {{1, 0}, {0.1, 0.9}}, 80);
  const auto stage = [&](double s) {
    BoundaryStage<Kepler> out{k.problem, s < 0.5 ? std::size_t(80) : std::size_t(160)};
    out.problem.boundary.source += s * Vector<double, 2>(0.1, -0.2);
    out.problem.boundary.target += s * Vector<double, 2>(-0.3, 0.1);
    if (s >= 0.5) out.problem.system.h /= 2;
    return out;
  };
  const BoundaryNewton<Kepler> solver;
  const auto end = follow(solver, stage, solver.solve(k.problem, k.path, true));
  ASSERT_TRUE(end.converged());
  EXPECT_EQ(end.solution.path.size(), 160U);
  EXPECT_EQ(end.solution.path.front().arrow.source, stage(1).problem.boundary.source);
  EXPECT_LT(end.solution.residual, 1e-10);
}

TEST(Continuation, SaysHowFarItCameWhereSolutionsEnd) {
  // Steps of the trace form turn by less than pi/2, so |c h| < 1: beyond spin 30 nothing can roll there.
  const auto stage = [](double s) {
    PlateBall system = plate_ball(30);
    system.rotation = RotationForm::trace;
    system.spin = 60 * s;
    return BoundaryStage<PlateBall>{{system, plate_ball_ends()}, 30};
  };
  const BoundaryNewton<PlateBall> solver;
  const auto start = solver.solve(stage(0).problem, straight(plate_ball(30), 30), false);
  ASSERT_TRUE(start.converged());
  HomotopyOptions options;
  options.smallest_step = 1e-2;
  const auto end = follow(solver, stage, start, options);
  EXPECT_FALSE(end.converged());
  EXPECT_LT(end.reached, 0.5);
  EXPECT_GT(end.failures, 0);
  EXPECT_TRUE(end.solution.converged());
}

TEST(Ceres, ItsStallIsTypedAndExplained) {
  // Normal equations square the condition number: on a path this long Ceres cannot reach the tolerance, Newton can.
  const std::size_t steps = 10000;
  const PlateBall system = plate_ball(steps);
  const BoundaryProblem<PlateBall> problem{system, plate_ball_ends()};
  const auto newton = BoundaryNewton<PlateBall>().solve(problem, straight(system, steps), false);
  ASSERT_TRUE(newton.converged());
  auto path = newton.path;
  for (auto& step : path) step.multipliers *= 1.0001;
  const auto ceres = BoundaryCeres<PlateBall>().solve(problem, path, true);
  EXPECT_EQ(ceres.status, SolveStatus::ill_conditioned) << ceres.residual;
  EXPECT_NE(ceres.message.find("solver.method = \"newton\""), std::string::npos);
  EXPECT_TRUE(BoundaryNewton<PlateBall>().solve(problem, path, true).converged());
}

}  // namespace
