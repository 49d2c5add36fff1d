// Plate-ball boundary-value problems: reference minima, degenerate cases, Ceres, typed failures.
#include <lagroid/solvers/boundary/boundary_ceres.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/control/plate_ball_boundary.hpp>

#include "../../support/plate_ball_cases.hpp"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <memory>
#include <numbers>
#include <vector>

using namespace lagroid;

namespace boundary_plate_ball_boundary_tests {
namespace {

using G = PlateBall::GroupoidType;

ArrowOf<G> boundary(const Vector<double, 2>& from, const Vector<double, 2>& to, const Vector<double, 3>& turn) {
  return {PairArrow<double, 2>{from, to}, SO3::exp(turn)};
}
ArrowOf<G> boundary(const cases::json& c) {
  const auto at = [&](const char* key) { return c.at(key).get<double>(); };
  return boundary(Vector<double, 2>(at("x0"), at("y0")), Vector<double, 2>(at("xT"), at("yT")),
                  cases::vector<3>(c.at("AT_rotation_vector")));
}

MultistartResult<PlateBall> solve(const PlateBall& system, const ArrowOf<G>& ends, long steps, bool ceres = false,
                                  std::uint64_t seed = 1) {
  PlateBallBoundaryOptions options;
  options.steps = steps;
  options.seed = seed;
  const auto method = ceres ? BoundaryMethod::ceres : BoundaryMethod::newton;
  return solve_plate_ball(*make_boundary_solver<PlateBall>(method), system, ends, options);
}

double end_defect(const PlateBall& system, const ArrowOf<G>& ends, const Path<PlateBall>& path) {
  ArrowOf<G> product = system.groupoid.unit(system.groupoid.source(ends));
  double gap = 0;
  for (const auto& step : path) {
    gap = std::max(gap, (std::get<0>(step.arrow).source - std::get<0>(product).target).norm());
    product = system.groupoid.multiply(product, step.arrow);
  }
  return gap + (system.groupoid.coordinates_of_arrow(product) - system.groupoid.coordinates_of_arrow(ends)).norm();
}

class BoundaryCase : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(BoundaryCase, BestMinimumIsTheReference) {
  const auto [id, form] = GetParam();
  const auto c = cases::find(id);
  const auto expected = c.at("results").at(form);
  const PlateBall system = cases::system(c, form);
  const auto ends = boundary(c);
  const auto found = solve(system, ends, c.at("N"));
  ASSERT_FALSE(found.solutions.empty());
  const auto& best = found.solutions.front();
  EXPECT_TRUE(best.kind.is_minimum);
  EXPECT_TRUE(best.kind.isolated);
  EXPECT_TRUE(best.kind.normal);
  EXPECT_NEAR(best.cost, cases::number(expected.at("cost")), 1e-11 * best.cost);
  const auto momentum = initial_momentum(system, best.path);
  EXPECT_LT((momentum.head<2>() - cases::vector<2>(expected.at("initial_momenta_px_py"))).norm(), 1e-9);
  EXPECT_LT((momentum.tail<3>() - cases::vector<3>(expected.at("initial_body_momentum_M0"))).norm(), 1e-9);
  EXPECT_LT((best.path.back().multipliers - cases::vector<3>(expected.at("last_step_lambda123"))).norm(), 1e-9);
  EXPECT_LT((final_momentum(system, best.path).tail<3>() - cases::vector<3>(expected.at("M_N"))).norm(), 1e-9);
  EXPECT_LT(end_defect(system, ends, best.path), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Cases, BoundaryCase,
                         ::testing::Combine(::testing::Values("P2-bvp-elastica", "P3-bvp-rotating"),
                                            ::testing::Values("trace", "exp", "cay")),
                         [](const auto& test) {
                           return std::get<0>(test.param).substr(0, 2) + "_" + std::get<1>(test.param);
                         });

class LocalMinima : public ::testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(LocalMinima, AllListedOnesAreFound) {
  const auto [id, seed] = GetParam();
  const auto c = cases::find(id);
  PlateBall system = cases::system(c, "exp");
  system.h = c.at("T").get<double>() / 20;
  const auto found = solve(system, boundary(c), 20, false, std::uint64_t(seed));
  const auto& all = c.at("local_minima_found_exp_N20");
  ASSERT_EQ(all.size(), 3U);
  for (const auto& listed : all) {
    const double cost = listed.at("cost");
    const bool met = std::any_of(found.solutions.begin(), found.solutions.end(), [&](const auto& s) {
      return std::abs(s.cost - cost) < 1e-9 * cost && s.kind.is_minimum &&
             (initial_momentum(system, s.path).template tail<3>() - cases::vector<3>(listed.at("M0"))).norm() < 1e-5;
    });
    EXPECT_TRUE(met) << cost;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, LocalMinima,
                         ::testing::Combine(::testing::Values("P2-bvp-elastica", "P3-bvp-rotating"),
                                            ::testing::Values(1, 2, 3)));

TEST(Multistart, IsReproducibleWhateverTheThreads) {
  PlateBall system;
  system.rotation = RotationForm::exponential;
  system.h = 0.1;
  const auto ends = boundary({0, 0}, {1, 0.5}, {0.6, -0.3, 0.9});
  const auto on = [&](int threads) {
    PlateBallBoundaryOptions options;
    options.steps = 10;
    options.seed = 7;
    options.threads = threads;
    return solve_plate_ball(*make_boundary_solver<PlateBall>(), system, ends, options);
  };
  const auto a = on(1);
  ASSERT_FALSE(a.solutions.empty());
  for (const int threads : {1, 2, 5}) {
    const auto b = on(threads);
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.outcomes, b.outcomes);
    ASSERT_EQ(a.solutions.size(), b.solutions.size());
    for (std::size_t i = 0; i < a.solutions.size(); ++i) {
      EXPECT_EQ(a.solutions[i].cost, b.solutions[i].cost);
      EXPECT_EQ(initial_momentum(system, a.solutions[i].path), initial_momentum(system, b.solutions[i].path));
    }
  }
}

TEST(Boundary, AngleNearPiFewStepsFastPlateSmallBall) {
  struct Case {
    double radius, rate, spin;
    long steps;
    double angle;
  };
  for (const Case c : {Case{1, 0, 0, 20, std::numbers::pi - 1e-6}, Case{1, 0, 0, 4, 1.1}, Case{1, 5, -1, 40, 1.1},
                       Case{0.02, 0, 0, 40, 1.1}, Case{1, 0.5, 0.3, 3, 0.5}}) {
    PlateBall system;
    system.radius = c.radius;
    system.plate_rate = c.rate;
    system.spin = c.spin;
    system.rotation = RotationForm::exponential;
    system.h = 1.0 / double(c.steps);
    const auto ends = boundary({0.2 * c.radius, -0.1 * c.radius}, {c.radius, 0.5 * c.radius},
                               Vector<double, 3>(0.6, -0.3, 0.9).normalized() * c.angle);
    const auto found = solve(system, ends, c.steps);
    ASSERT_FALSE(found.solutions.empty()) << c.steps;
    EXPECT_TRUE(found.solutions.front().kind.is_minimum);
    EXPECT_LT(end_defect(system, ends, found.solutions.front().path), 1e-12);
    EXPECT_LT(found.solutions.front().residual, 1e-12);
  }
}

TEST(Boundary, StraightRollingIsAbnormal) {
  PlateBall system;
  system.rotation = RotationForm::exponential;
  system.h = 0.05;
  const auto found = solve(system, boundary({0, 0}, {1, 0}, {0, 1, 0}), 20);
  ASSERT_FALSE(found.solutions.empty());
  const auto& best = found.solutions.front();
  EXPECT_NEAR(best.cost, 0.5, 1e-10);
  EXPECT_TRUE(best.kind.is_minimum);
  EXPECT_FALSE(best.kind.normal);
}

TEST(Boundary, TurningInPlaceIsAFamily) {
  PlateBall system;
  system.h = 0.05;
  for (const auto form : {RotationForm::trace, RotationForm::exponential, RotationForm::cayley}) {
    system.rotation = form;
    const auto found = solve(system, boundary({0, 0}, {0, 0}, {0, 0, 1}), 20);
    ASSERT_FALSE(found.solutions.empty());
    EXPECT_TRUE(found.solutions.front().kind.is_minimum);
    EXPECT_FALSE(found.solutions.front().kind.isolated);
    EXPECT_TRUE(found.solutions.front().kind.normal);
  }
}

TEST(Boundary, ContinuationInNReachesThousands) {
  // Second order in 1/N towards the continuous minimum of the case file.
  const double continuous = cases::find("P2-bvp-elastica").at("continuous").at("cost");
  PlateBall system;
  system.rotation = RotationForm::exponential;
  std::vector<double> errors;
  for (const long steps : {1000, 2000}) {
    system.h = 1.0 / double(steps);
    const auto found = solve(system, boundary({0, 0}, {1, 0.5}, {0.6, -0.3, 0.9}), steps);
    ASSERT_FALSE(found.solutions.empty()) << steps;
    EXPECT_EQ(found.solutions.front().path.size(), std::size_t(steps));
    errors.push_back(std::abs(found.solutions.front().cost - continuous));
  }
  EXPECT_LT(errors[0], 1e-4);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.05);
}

TEST(Boundary, MinimaSurviveTheirInitialValueProblem) {
  // From the start and the momentum of the boundary solution the integrator takes the same steps, to the same end.
  for (const char* id : {"P2-bvp-elastica", "P3-bvp-rotating"})
    for (const char* form : {"trace", "exp", "cay"}) {
      SCOPED_TRACE(std::string(id) + " " + form);
      const auto c = cases::find(id);
      const PlateBall system = cases::system(c, form);
      const auto& groupoid = system.groupoid;
      const auto ends = boundary(c);
      const auto found = solve(system, ends, c.at("N"));
      int minima = 0;
      for (const auto& solution : found.solutions) {
        if (!solution.kind.is_minimum) continue;
        ++minima;
        const State<G> start{groupoid.source(ends), initial_momentum(system, solution.path)};
        FixedStepIntegrator<PlateBall> integrator(system, start, groupoid.unit(start.object),
                                                  std::make_unique<NewtonStep<PlateBall>>());
        for (const auto& step : solution.path) {
          ASSERT_TRUE(integrator.advance().converged()) << integrator.point().index;
          const auto& taken = integrator.point().step;
          EXPECT_LT((groupoid.coordinates_of_arrow(taken.arrow) - groupoid.coordinates_of_arrow(step.arrow)).norm(),
                    1e-9);
          EXPECT_LT((taken.multipliers - step.multipliers).norm(), 1e-8);
        }
        const auto& end = integrator.point();
        EXPECT_LT((groupoid.coordinates_of_arrow(end.configuration) - groupoid.coordinates_of_arrow(ends)).norm(),
                  1e-9);
        EXPECT_LT((end.state.momentum - final_momentum(system, solution.path)).norm(), 1e-8);
      }
      EXPECT_GE(minima, 2);
    }
}

TEST(Ceres, FindsTheSameBestMinimum) {
  const auto c = cases::find("P2-bvp-elastica");
  PlateBall system = cases::system(c, "exp");
  system.h = 1.0 / 20;
  const auto found = solve(system, boundary(c), 20, /*ceres=*/true);
  ASSERT_FALSE(found.solutions.empty());
  EXPECT_NEAR(found.solutions.front().cost, 13.131553378463718, 1e-10);
  EXPECT_TRUE(found.solutions.front().kind.is_minimum);
}

TEST(Boundary, DecidableImpossibilitiesAreRefused) {
  PlateBall system;
  system.h = 0.5;
  EXPECT_TRUE(unreachable(system, 2).has_value());
  EXPECT_FALSE(unreachable(system, 3).has_value());
  system.spin = 2;
  EXPECT_TRUE(unreachable(system, 10).has_value());
  system.rotation = RotationForm::exponential;
  EXPECT_FALSE(unreachable(system, 10).has_value());
  EXPECT_THROW(solve(system, boundary({0, 0}, {1, 0}, {0, 0, 0}), 2), std::invalid_argument);
  system.spin = std::nan("");
  EXPECT_TRUE(unreachable(system, 10).has_value());
  system.spin = 6.3;
  EXPECT_TRUE(unreachable(system, 10).has_value());
  system.rotation = RotationForm::cayley;
  EXPECT_FALSE(unreachable(system, 10).has_value());
}

TEST(Boundary, TheUnreachableIsATypedOutcomeWithAResidual) {
  // Three steps of the trace form turn by less than pi/2 each: 100 radii in three steps is out of reach.
  PlateBall system;
  system.h = 1.0 / 3;
  const auto found = solve(system, boundary({0, 0}, {100, 0}, {0, 0, 0}), 3);
  EXPECT_TRUE(found.solutions.empty());
  EXPECT_NE(found.best_failure.status, SolveStatus::converged);
  EXPECT_GT(found.best_failure.residual, 1e-3);
}

TEST(Kkt, MatrixIsTheDerivativeOfTheEquationsAtASolution) {
  const auto c = cases::find("P2-bvp-elastica");
  PlateBall system = cases::system(c, "exp");
  system.h = 1.0 / 8;
  const auto ends = boundary(c);
  const auto found = solve(system, ends, 8);
  ASSERT_FALSE(found.solutions.empty());
  const BoundaryProblem<PlateBall> problem{system, ends};
  const auto& path = found.solutions.front().path;
  BoundaryKkt<PlateBall> kkt;
  kkt.evaluate(system, path);
  BoundaryKkt<PlateBall>::Columns z(8, Vector<double, 8>::Zero());
  Variation<PlateBall> variation(8);
  std::srand(1);
  for (int k = 0; k < 8; ++k) {
    variation.multipliers[k].setRandom();
    if (k < 7) variation.nodes[k].setRandom();
    z[k] << variation.multipliers[k], variation.nodes[k];
  }
  const auto product = kkt.multiply(z);
  const double e = 1e-6;
  BoundaryKkt<PlateBall> plus;
  plus.evaluate(system, displaced(problem, path, variation, e));
  BoundaryKkt<PlateBall> minus;
  minus.evaluate(system, displaced(problem, path, variation, -e));
  for (int k = 0; k < 8; ++k) {
    const auto difference = ((plus.residual()[k] - minus.residual()[k]) / (2 * e)).eval();
    EXPECT_LT((difference - product[k]).norm(), 1e-6 * (1 + product[k].norm())) << k;
  }
}

TEST(Ceres, GradientDerivativeIsExactAwayFromSolutions) {
  PlateBall system;
  system.plate_rate = 0.8;
  system.rotation = RotationForm::exponential;
  const auto& groupoid = system.groupoid;
  const ArrowOf<G> g{PairArrow<double, 2>{{0.1, 0.2}, {0.3, 0.1}}, SO3::exp(Vector<double, 3>(0.2, -0.5, 0.3))};
  const Vector<double, 3> lambda(2, -3, 1.5);
  const Vector<double, 5> zero = Vector<double, 5>::Zero();
  const double e = 1e-6;
  for (int j = 0; j < 5; ++j) {
    const Vector<double, 5> v = e * Vector<double, 5>::Unit(j);
    const Vector<double, 5> back = -v;
    const Vector<double, 5> target = (two_sided(system, groupoid.translate(zero, g, v), lambda).target_gradient -
                                      two_sided(system, groupoid.translate(zero, g, back), lambda).target_gradient) /
                                     (2 * e);
    const Vector<double, 5> source = (two_sided(system, groupoid.translate(v, g, zero), lambda).source_gradient -
                                      two_sided(system, groupoid.translate(back, g, zero), lambda).source_gradient) /
                                     (2 * e);
    EXPECT_LT((gradient_derivative(system, g, lambda, End::target).col(j) - target).norm(), 1e-7);
    EXPECT_LT((gradient_derivative(system, g, lambda, End::source).col(j) - source).norm(), 1e-7);
  }
  // The symmetric Hessian differs: that is the bracket.
  EXPECT_GT(
      (gradient_derivative(system, g, lambda, End::target) - one_sided_hessian(system, g, lambda, End::target)).norm(),
      0.1);
}

/// Negative eigenvalues of the Hessian on the null space of the constraint Jacobian, both dense.
long dense_negative_directions(const PlateBall& system, const Path<PlateBall>& path) {
  BoundaryKkt<PlateBall> kkt;
  kkt.evaluate(system, path);
  const int count = int(path.size());
  Eigen::MatrixXd full(8 * count, 8 * count);
  for (int column = 0; column < 8 * count; ++column) {
    BoundaryKkt<PlateBall>::Columns z(count, Vector<double, 8>::Zero());
    z[column / 8](column % 8) = 1;
    const auto image = kkt.multiply(z);
    for (int k = 0; k < count; ++k) full.block<8, 1>(8 * k, column) = image[k];
  }
  Eigen::MatrixXd hessian(5 * (count - 1), 5 * (count - 1));
  Eigen::MatrixXd jacobian(3 * count, 5 * (count - 1));
  for (int k = 0; k < count; ++k)
    for (int l = 0; l + 1 < count; ++l) {
      jacobian.block<3, 5>(3 * k, 5 * l) = full.block<3, 5>(8 * k, 8 * l + 3);
      if (k + 1 < count) hessian.block<5, 5>(5 * k, 5 * l) = full.block<5, 5>(8 * k + 3, 8 * l + 3);
    }
  const Eigen::MatrixXd kernel = jacobian.fullPivLu().kernel();
  const Eigen::MatrixXd basis =
      kernel.householderQr().householderQ() * Eigen::MatrixXd::Identity(kernel.rows(), kernel.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(basis.transpose() * hessian * basis);
  return (eigen.eigenvalues().array() < 0).count();
}

TEST(Classification, TellsSaddlesFromMinima) {
  // Ceres is attracted by any stationary point; each classification is compared with a dense one.
  const auto c = cases::find("P2-bvp-elastica");
  PlateBall system = cases::system(c, "exp");
  system.h = 1.0 / 12;
  const auto found = solve(system, boundary(c), 12, /*ceres=*/true);
  int saddles = 0;
  int minima = 0;
  for (const auto& s : found.solutions) {
    EXPECT_EQ(s.kind.negative_directions, dense_negative_directions(system, s.path)) << s.cost;
    EXPECT_EQ(s.kind.is_minimum, s.kind.negative_directions == 0);
    (s.kind.is_minimum ? minima : saddles)++;
  }
  EXPECT_GE(saddles, 2);
  EXPECT_GE(minima, 2);
}

TEST(Boundary, UnitsOfLengthDoNotMatter) {
  for (const double r : {1e-3, 1.0, 100.0}) {
    PlateBall system;
    system.rotation = RotationForm::exponential;
    system.radius = r;
    system.plate_rate = 0.5;
    system.h = 1.0 / 12;
    const auto found = solve(system, boundary({0.2 * r, -0.1 * r}, {r, 0.5 * r}, {0.6, -0.3, 0.9}), 12);
    ASSERT_FALSE(found.solutions.empty()) << r;
    EXPECT_GE(found.outcomes.at(SolveStatus::converged), 36) << r;
    PlateBall unit = system;
    unit.radius = 1;
    const auto reference = solve(unit, boundary({0.2, -0.1}, {1, 0.5}, {0.6, -0.3, 0.9}), 12);
    ASSERT_EQ(found.solutions.size(), reference.solutions.size()) << r;
    for (std::size_t i = 0; i < found.solutions.size(); ++i)
      EXPECT_NEAR(found.solutions[i].cost / (r * r), reference.solutions[i].cost, 1e-10 * reference.solutions[i].cost);
    EXPECT_LT(
        end_defect(system, boundary({0.2 * r, -0.1 * r}, {r, 0.5 * r}, {0.6, -0.3, 0.9}), found.solutions.front().path),
        1e-12 * (1 + r));
  }
}

TEST(Boundary, LargeTurnsPerStep) {
  // Costs of paths found by an independent program (sequential quadratic programming in Python) for the same ends.
  struct Case {
    RotationForm form;
    double spin, known;
  };
  for (const Case c : {Case{RotationForm::cayley, 58, 1.45604}, Case{RotationForm::exponential, 58, 5.36557},
                       Case{RotationForm::exponential, 40, 9.01308}}) {
    PlateBall system;
    system.rotation = c.form;
    system.spin = c.spin;
    system.h = 1.0 / 20;
    const auto found = solve(system, boundary({0, 0}, {1, 0.5}, {0.6, -0.3, 0.9}), 20);
    ASSERT_FALSE(found.solutions.empty()) << c.spin;
    EXPECT_LT(found.solutions.front().cost, c.known * (1 + 1e-5)) << c.spin;
  }
}

TEST(Kkt, SolveInvertsMultiply) {
  PlateBall system;
  system.h = 0.1;
  system.rotation = RotationForm::exponential;
  const auto ends = boundary({0, 0}, {1, 0.5}, {0.6, -0.3, 0.9});
  Path<PlateBall> path;
  for (auto& arrow : system.path(ends, 10, Eigen::Matrix2Xd::Constant(2, 2, 0.5)))
    path.push_back({arrow, {1, -2, 0.5}});
  BoundaryKkt<PlateBall> kkt;
  kkt.evaluate(system, path);
  kkt.choose_scale();
  kkt.factor(0, 0);
  BoundaryKkt<PlateBall>::Columns z(10);
  std::srand(2);
  for (auto& c : z) c.setRandom();
  z.back().tail<5>().setZero();
  const auto back = kkt.solve(kkt.multiply(z));
  for (int k = 0; k < 10; ++k) EXPECT_LT((back[k] - z[k]).norm(), 1e-9);
}

}  // namespace
}  // namespace boundary_plate_ball_boundary_tests
