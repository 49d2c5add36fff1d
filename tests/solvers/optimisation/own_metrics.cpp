// Hyperbolic space and positive definite matrices: forms that do not cancel, means, and every method on them.
#include "instances.hpp"

#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/matrices/matrix_functions.hpp>
#include <lagroid/solvers/optimisation/manifolds/flat.hpp>
#include <lagroid/solvers/optimisation/manifolds/hyperbolic_space.hpp>
#include <lagroid/solvers/optimisation/manifolds/positive_definite.hpp>
#include <lagroid/solvers/optimisation/manifolds/product.hpp>
#include <lagroid/solvers/optimisation/manifolds/sphere.hpp>
#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>
#include <lagroid/solvers/optimisation/methods/conjugate_gradient.hpp>
#include <lagroid/solvers/optimisation/methods/euler_lagrange.hpp>
#include <lagroid/solvers/optimisation/methods/gradient_descent.hpp>
#include <lagroid/solvers/optimisation/methods/trust_region.hpp>
#include <lagroid/solvers/optimisation/testing/manifold_laws.hpp>
#include <lagroid/systems/optimisation/frechet_mean.hpp>

#include "../../support/broken.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::optimisation::tests::own_metrics_tests {
namespace {

/// The point of the plane in polar coordinates.
Point polar(double radius, double angle) {
  Point x(3);
  x << std::cosh(radius), std::sinh(radius) * std::cos(angle), std::sinh(radius) * std::sin(angle);
  return x;
}

TEST(HyperbolicSpace, DistancesKeepTheirDigits) {
  const HyperbolicSpace plane(2);
  Vector v;
  const auto distance = [&](const Point& x, const Point& y) {
    EXPECT_TRUE(plane.logarithm(x, y, v));
    return plane.norm(x, v);
  };
  for (const double radius : {1e-9, 1e-3, 1.0, 10.0, 17.0})
    for (const double apart : {1e-12, 1e-6, 1.0, 10.0}) {
      // Along an axis, from which rounding does not turn it, and as a chord by the law of cosines.
      const double there = radius + apart;
      EXPECT_NEAR(distance(polar(radius, 0), polar(there, 0)), there - radius, 1e-15 * there) << radius << ' ' << apart;
      const double angle = apart / std::sinh(radius);
      if (angle > 3) continue;
      const double chord = 2 * std::asinh(std::sinh(radius) * std::sin(0.5 * angle));
      EXPECT_NEAR(distance(polar(radius, 0), polar(radius, angle)), chord, 4e-15 * chord) << radius << ' ' << apart;
    }
}

TEST(HyperbolicSpace, LogarithmsOfPointsFarApartAreRightOrNone) {
  const HyperbolicSpace plane(2);
  Vector v;
  for (const double radius : {100.0, 180.0, 340.0}) {
    const Point x = polar(radius, 0);
    Point y = x;
    y(1) = -y(1);
    ASSERT_TRUE(plane.logarithm(x, y, v)) << radius;
    // Straight inwards: of the length 2 radius at x, where the norm itself has lost its digits.
    EXPECT_NEAR(v(1) / (-2 * radius * x(0)), 1, 1e-14) << radius;
    EXPECT_EQ(v(2), 0);
  }
  EXPECT_FALSE(plane.logarithm(polar(355, 0), polar(355, 3), v));
}

TEST(HyperbolicSpace, GradientsAreThoseOfTheirDifferentialsFarOut) {
  const HyperbolicSpace plane(2);
  for (const double radius : {1.0, 8.0, 17.0})
    for (const double angle : {0.0, 0.3, 2.0}) {
      const Point x = polar(radius, angle);
      // Of length sqrt(2), as much along the radius as across.
      Vector v(3);
      v << 0, std::cosh(radius) * std::cos(angle) - std::sin(angle),
          std::cosh(radius) * std::sin(angle) + std::cos(angle);
      plane.project(x, v);
      Vector back = v;
      plane.differential(x, back);
      plane.gradient(x, back);
      EXPECT_LT(plane.norm(x, back - v), 4e-16 * std::exp(radius)) << radius << ' ' << angle;
    }
}

TEST(HyperbolicSpace, GeodesicsReachTheOriginFromFarOut) {
  const HyperbolicSpace plane(2);
  Point to;
  Vector v(3);
  for (const double radius : {1.0, 5.0, 15.0}) {
    // Along an axis, from which rounding does not turn it.
    const Point x = polar(radius, 0);
    v << -radius * std::sinh(radius), -radius * std::cosh(radius), 0;
    ASSERT_TRUE(plane.retract(ManifoldRetraction::exponential, x, v, to));
    EXPECT_LT(to.tail(2).norm(), 1e-15 * std::exp(radius)) << radius;
    EXPECT_LT(plane.residual(to), 1e-15);
  }
}

TEST(HyperbolicSpace, LawsHoldFarOut) {
  // To what rounding leaves at e^8.
  const HyperbolicSpace space(3);
  const auto report = laws::manifold_laws(space, [] {
    Point x(4);
    for (double& each : x) each = laws::draw_uniform();
    return Point(std::sinh(8.0) * x);
  });
  for (const char* law : {"nearest points lie on it", "retraction exponential lands on it",
                          "the metric is symmetric, linear and positive", "the gradient is that of the metric"})
    EXPECT_TRUE(report.law(law).holds()) << report;
  EXPECT_LT(report.law("the logarithm inverts the exponential").worst, 1e-11) << report;
  EXPECT_LT(report.law("parallel transport is an isometry that carries geodesics along").worst, 1e-10) << report;
}

TEST(PositiveDefinite, IsTheSameInEveryBasis) {
  const PositiveDefinite manifold(3);
  const MatrixXd basis = random_matrix(3, 3, 4);
  const auto definite = [](unsigned seed) {
    const MatrixXd a = random_matrix(3, 3, seed);
    return MatrixXd(a * a.transpose() + MatrixXd::Identity(3, 3));
  };
  const auto moved = [&](const MatrixXd& x) -> Point { return (basis * x * basis.transpose()).reshaped(); };
  const MatrixXd x = definite(1);
  const MatrixXd y = definite(2);
  Vector v;
  Vector w;
  ASSERT_TRUE(manifold.logarithm(x.reshaped(), y.reshaped(), v));
  ASSERT_TRUE(manifold.logarithm(moved(x), moved(y), w));
  EXPECT_LT((w - moved(as_matrix(v, 3))).norm(), 1e-12 * w.norm());
  // d^2 = sum log^2 of the eigenvalues of X^-1 Y.
  const Eigen::VectorXd values = matrix_eigenvalues(inverse_of(x) * y).real();
  EXPECT_NEAR(manifold.norm(x.reshaped(), v), values.array().log().matrix().norm(), 1e-13);
  // Of neighbours no digits are lost, however long they are.
  for (const double scale : {1e-100, 1.0, 1e100}) {
    const Point here = scale * x.reshaped();
    const double e = 1e-12;
    ASSERT_TRUE(manifold.logarithm(here, (1 + e) * here, v));
    EXPECT_NEAR(manifold.norm(here, v), e * std::sqrt(3.0), 1e-15);
  }
}

/// One of each, those with options that are the manifold's to choose.
std::vector<std::unique_ptr<DescentMethod>> methods(double diameter) {
  std::vector<std::unique_ptr<DescentMethod>> out;
  const AcceleratedOptions geodesic{.constraint = Constraint::geodesics};
  out.push_back(std::make_unique<GradientDescent>(GradientDescentOptions{}));
  out.push_back(std::make_unique<GradientDescent>(GradientDescentOptions{.c = 1}));
  out.push_back(std::make_unique<ConjugateGradient>());
  out.push_back(std::make_unique<TrustRegion>());
  for (const int version : {1, 2})
    out.push_back(
        std::make_unique<EulerLagrange>(EulerLagrangeOptions{.h = 0.02, .version = version, .diameter = diameter}));
  for (const Bregman::Kind kind : {Bregman::Kind::direct, Bregman::Kind::adaptive})
    out.push_back(std::make_unique<HamiltonianDescent>(
        HamiltonianOptions{.bregman = {.kind = kind}, .h = 0.02, .diameter = diameter}, geodesic));
  out.push_back(std::make_unique<RobustDescent>(RobustOptions{}, geodesic));
  out.push_back(std::make_unique<RobustDescent>(
      RobustOptions{.c = 1, .power = 2},
      AcceleratedOptions{.constraint = Constraint::geodesics, .restart = true, .look_ahead = true}));
  return out;
}

void expect_all_find(const Manifold& manifold, const Objective& objective, const Point& start, const Point& mean,
                     double diameter) {
  for (const auto& method : methods(diameter)) {
    const Result r = minimise(manifold, objective, start, *method, {.gradient = 1e-8, .iterations = 6000});
    EXPECT_TRUE(r.converged()) << manifold.name() << ", " << method->name() << ": " << r.message;
    Vector off;
    ASSERT_TRUE(manifold.logarithm(mean, r.x, off));
    EXPECT_LT(manifold.norm(mean, off), 1.1e-8) << manifold.name() << ", " << method->name();
    EXPECT_LT(r.residual, 1e-14);
  }
}

TEST(FrechetMean, OfTwoPointsLiesBetweenThem) {
  const HyperbolicSpace plane(2);
  const PositiveDefinite matrices(2);
  const Eigen::Vector2d weights(1, 3);
  const auto expect = [&](const Manifold& manifold, const Point& x, const Point& y, const Point& start) {
    Vector v;
    Point mean;
    ASSERT_TRUE(manifold.logarithm(x, y, v));
    ASSERT_TRUE(manifold.retract(ManifoldRetraction::exponential, x, 0.75 * v, mean));
    expect_all_find(manifold, FrechetMean(manifold, {x, y}, weights), start, mean, 4);
  };
  expect(plane, polar(1.5, 0), polar(2, 2), polar(0.5, 4));
  expect(matrices, Eigen::Vector4d(2, 1, 1, 3), Eigen::Vector4d(1, -0.5, -0.5, 0.5), Eigen::Vector4d(1, 0, 0, 1));
  // Where transport is known, on spheres and O(n), too.
  expect(Sphere(3), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0.6, 0, 0.8));
  const Eigen::Matrix3d turned = matrix_exponential(Eigen::Matrix3d{{0, 1, 0}, {-1, 0, 0.5}, {0, -0.5, 0}});
  expect(Stiefel(3, 3), Eigen::Matrix3d::Identity().reshaped(), turned.reshaped(), turned.transpose().reshaped());
}

TEST(FrechetMean, IsFoundFarOut) {
  const HyperbolicSpace plane(2);
  Point x(3);
  x << 0, 1e8, 0;
  Point y(3);
  y << 0, -1e8, 0;
  ASSERT_TRUE(plane.nearest(x) && plane.nearest(y));
  TrustRegion method;
  const Result r = minimise(plane, FrechetMean(plane, {x, y}), x, method, {.gradient = 1e-10});
  ASSERT_TRUE(r.converged()) << r.message;
  EXPECT_LT(r.x.tail(2).norm(), 1e-9);
}

TEST(FrechetMean, OfOnePointIsFoundAtTheStart) {
  const HyperbolicSpace plane(2);
  const PositiveDefinite matrices(2);
  const Sphere sphere(3);
  const auto outcome = [](const Manifold& manifold, const std::vector<Point>& points) {
    TrustRegion method;
    return minimise(manifold, FrechetMean(manifold, points), points[0], method, {.relative_gradient = 1e-8}).outcome;
  };
  const Point x = polar(1.5, 0.3);
  const Point ellipse = Eigen::Vector4d(2, 1, 1, 3);
  EXPECT_EQ(outcome(plane, {x}), MinimisationStatus::converged);
  EXPECT_EQ(outcome(plane, {x, x, x}), MinimisationStatus::converged);
  EXPECT_EQ(outcome(matrices, {ellipse, ellipse}), MinimisationStatus::converged);
  // Where a mean is not convex, a point without slope need not be one.
  EXPECT_EQ(outcome(sphere, {Eigen::Vector3d(1, 0, 0)}), MinimisationStatus::stationary_start);

  std::vector<std::unique_ptr<Manifold>> factors;
  factors.push_back(std::make_unique<HyperbolicSpace>(2));
  factors.push_back(std::make_unique<PositiveDefinite>(2));
  const ProductManifold both(std::move(factors));
  Point pair(7);
  pair << x, ellipse;
  EXPECT_TRUE(FrechetMean(both, {pair}).convex());
  factors.clear();
  factors.push_back(std::make_unique<HyperbolicSpace>(2));
  factors.push_back(std::make_unique<Sphere>(3));
  const ProductManifold mixed(std::move(factors));
  Point other(6);
  other << x, 1, 0, 0;
  EXPECT_FALSE(FrechetMean(mixed, {other}).convex());
  EXPECT_TRUE(FrechetMean(FlatSpace(2), {Eigen::Vector2d(1, 2)}).convex());
}

TEST(FrechetMean, OfMatricesThatCommuteIsTheExponentialOfTheMeanLogarithm) {
  const PositiveDefinite manifold(3);
  const MatrixXd axes = orthogonal_factor(random_matrix(3, 3, 1));
  std::vector<Point> points;
  Eigen::Vector3d logarithms = Eigen::Vector3d::Zero();
  const auto of = [&](const Eigen::Vector3d& values) -> Point {
    return (axes * values.array().exp().matrix().asDiagonal() * axes.transpose()).reshaped();
  };
  for (unsigned i = 0; i < 4; ++i) {
    const Eigen::Vector3d values = random_matrix(3, 1, i + 10);
    logarithms += values / 4;
    points.push_back(of(values));
  }
  const Point start = points.front();
  expect_all_find(manifold, FrechetMean(manifold, std::move(points)), start, of(logarithms), 6);
}

TEST(FrechetMean, KnowsNoUnits) {
  // Of matrices a million times as large, and more: the same iterations, and the same mean but for that.
  const PositiveDefinite manifold(2);
  const auto found = [&](double scale) {
    const std::vector<Point> points{scale * Eigen::Vector4d(2, 1, 1, 3), scale * Eigen::Vector4d(1, 0, 0, 5),
                                    scale * Eigen::Vector4d(4, -1, -1, 1)};
    TrustRegion method;
    return minimise(manifold, FrechetMean(manifold, points), points[0], method, {.gradient = 1e-9});
  };
  const Result one = found(1);
  ASSERT_TRUE(one.converged()) << one.message;
  for (const double scale : {1e-20, 1e-14, 1e-6, 1e6, 1e20}) {
    const Result other = found(scale);
    EXPECT_TRUE(other.converged()) << scale << ": " << other.message;
    EXPECT_EQ(other.iterations, one.iterations) << scale;
    EXPECT_LT((other.x / scale - one.x).norm(), 1e-9) << scale;
  }
}

TEST(FrechetMean, IsAnObjective) {
  const HyperbolicSpace plane(2);
  const FrechetMean hyperbolic(plane, {polar(1, 0), polar(2, 1), polar(1.5, 3)});
  const auto report = laws::objective_laws(plane, hyperbolic);
  EXPECT_TRUE(report.holds()) << report;
  EXPECT_TRUE(report.law("a convex function lies above its tangents").holds());
  const PositiveDefinite matrices(2);
  const FrechetMean mean(matrices, {Eigen::Vector4d(2, 1, 1, 3), Eigen::Vector4d(1, 0, 0, 5)});
  const auto definite = laws::objective_laws(matrices, mean, [] {
    const double a = laws::draw_uniform();
    return Point(Eigen::Vector4d(1 + a * a, a, a, 1));
  });
  EXPECT_TRUE(definite.holds()) << definite;

  EXPECT_THROW(FrechetMean(plane, {}), std::invalid_argument);
  EXPECT_THROW(FrechetMean(plane, {Eigen::Vector3d(1, 1, 0)}), std::invalid_argument);
  EXPECT_THROW(FrechetMean(plane, {Eigen::Vector4d(1, 0, 0, 0)}), std::invalid_argument);
  EXPECT_THROW(FrechetMean(plane, {polar(1, 0), polar(2, 0)}, Eigen::Vector2d(1, 0)), std::invalid_argument);
  EXPECT_THROW(FrechetMean(matrices, {Eigen::Vector4d(1, 2, 2, 1)}), std::invalid_argument);
}

TEST(OwnMetrics, SayWhatTheyDoNotOffer) {
  const HyperbolicSpace plane(2);
  const FrechetMean mean(plane, {polar(1, 0), polar(2, 1)});
  const auto refused = [&](DescentMethod& method) -> std::string {
    try {
      minimise(plane, mean, polar(1, 0), method, {});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  RobustDescent multipliers = robust();
  EXPECT_NE(refused(multipliers).find("take the constraint geodesics"), std::string::npos);
  ConjugateGradient qr(ManifoldRetraction::qr);
  EXPECT_NE(refused(qr).find("take one of: exponential"), std::string::npos);
  HamiltonianDescent no_domain({}, {.constraint = Constraint::geodesics});
  EXPECT_NE(refused(no_domain).find("diameter"), std::string::npos);
  HamiltonianDescent by_lambda({.bregman = {.lambda = 2}}, {.constraint = Constraint::geodesics});
  EXPECT_EQ(refused(by_lambda), "");
  EulerLagrange without({});
  EXPECT_NE(refused(without).find("lambda"), std::string::npos);
  EXPECT_THROW(EulerLagrange({.diameter = -1}), std::invalid_argument);
  EXPECT_THROW(HyperbolicSpace(0), std::invalid_argument);
  EXPECT_THROW(PositiveDefinite(0), std::invalid_argument);
}

TEST(OwnMetrics, LambdaIsZetaUnlessItIsGiven) {
  const HyperbolicSpace plane(2);
  const FrechetMean mean(plane, {polar(1, 0), polar(2, 1), polar(1.5, 3)});
  const auto found = [&](const Manifold& manifold, const Objective& f, const Point& start, Bregman bregman,
                         double diameter) {
    HamiltonianDescent method({.bregman = bregman, .h = 0.02, .diameter = diameter},
                              {.constraint = Constraint::geodesics});
    return minimise(manifold, f, start, method, {.iterations = 50}).x;
  };
  const Point start = polar(1, 0);
  const Point automatic = found(plane, mean, start, {}, 3);
  EXPECT_EQ(automatic, found(plane, mean, start, {.lambda = zeta(-1, 3)}, 0));
  EXPECT_NE(automatic, found(plane, mean, start, {.lambda = 1}, 3));
  const RandomInstance problem = rayleigh(1);
  EXPECT_EQ(found(*problem.manifold, *problem.objective, problem.start, {}, 0),
            found(*problem.manifold, *problem.objective, problem.start, {.lambda = 1}, 0));

  const auto by_euler_lagrange = [&](std::optional<double> lambda, double diameter) {
    EulerLagrange method({.h = 0.02, .lambda = lambda, .diameter = diameter});
    return minimise(plane, mean, start, method, {.iterations = 50}).x;
  };
  EXPECT_EQ(by_euler_lagrange({}, 3), by_euler_lagrange(zeta(-1, 3), 0));
  EXPECT_NE(by_euler_lagrange({}, 3), by_euler_lagrange(1, 3));
}

TEST(EulerLagrange, ConvergesWithALargeLambda) {
  // Not where its coefficient b_k is negative: there the first velocities would grow by 2^(lambda p).
  const HyperbolicSpace plane(2);
  const FrechetMean mean(plane, {polar(1, 0), polar(2, 1), polar(1.5, 3)});
  for (const int version : {1, 2}) {
    EulerLagrange method({.h = 0.02, .version = version, .diameter = 10});
    const Result r = minimise(plane, mean, polar(1, 0), method, {.gradient = 1e-8});
    EXPECT_TRUE(r.converged()) << version << ": " << r.message;
  }
}

}  // namespace
}  // namespace lagroid::optimisation::tests::own_metrics_tests
