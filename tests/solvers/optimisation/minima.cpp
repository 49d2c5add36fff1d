// Derivatives of least values and of their minimisers: closed forms, differences, minima that are not strict.
#include "instances.hpp"

#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/solvers/optimisation/manifolds/flat.hpp>
#include <lagroid/solvers/optimisation/manifolds/hyperbolic_space.hpp>
#include <lagroid/solvers/optimisation/manifolds/positive_definite.hpp>
#include <lagroid/solvers/optimisation/manifolds/product.hpp>
#include <lagroid/solvers/optimisation/manifolds/sphere.hpp>
#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>
#include <lagroid/solvers/optimisation/sensitivity/minimum_derivatives.hpp>
#include <lagroid/solvers/optimisation/testing/parametric_laws.hpp>
#include <lagroid/systems/optimisation/frechet_mean.hpp>
#include <lagroid/systems/optimisation/procrustes.hpp>
#include <lagroid/systems/optimisation/random.hpp>
#include <lagroid/systems/optimisation/rayleigh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::optimisation::tests::minima_tests {
namespace {

/// By all numbers of that name, at the minimum that the trust region method finds.
MinimumDerivatives derivatives_from(const Manifold& manifold, const ParametricObjective& f, const Point& start,
                                    const std::string& name, const MinimumOptions& options = {}) {
  TrustRegion method;
  const Result found = minimise(manifold, f, start, method, {.relative_gradient = 1e-9});
  EXPECT_TRUE(found.converged()) << found.message;
  return minimum_derivatives(manifold, f, found.x, entries_named(f.parameters(), name), options);
}

/// E with ones at (i, j) and (j, i).
MatrixXd changed_by(const ParameterEntry& which, Eigen::Index n) {
  MatrixXd out = MatrixXd::Zero(n, n);
  out(which.row, which.column) = out(which.column, which.row) = 1;
  return out;
}

TEST(MinimumDerivatives, OfEigenvaluesAreProductsOfTheirVectors) {
  const Eigen::Index n = 7;
  const MatrixXd a = random_symmetric(n, 3);
  const auto by = derivatives_from(Sphere(n), Rayleigh(SymmetricOperator::of(a)), VectorXd::Unit(n, 0), "A");
  ASSERT_EQ(by.status, MinimumStatus::strict) << by.message;
  const VectorXd v = symmetric_eigenvectors(a).vectors.col(n - 1);
  for (Eigen::Index k = 0; k < by.value_by.size(); ++k) {
    const MatrixXd e = changed_by(by.parameters[std::size_t(k)], n);
    EXPECT_NEAR(by.value_by(k), -v.dot(e * v), 1e-13);
  }
  EXPECT_GT(by.value_digits, 14);
}

TEST(MinimumDerivatives, OfEigenvectorsAreThoseOfThePseudoInverse) {
  const Eigen::Index n = 7;
  const MatrixXd a = random_symmetric(n, 3);
  const auto by = derivatives_from(Sphere(n), Rayleigh(SymmetricOperator::of(a)), VectorXd::Unit(n, 0), "A");
  const auto [values, vectors] = symmetric_eigenvectors(a);
  VectorXd inverse = (values(n - 1) - values.array()).inverse();
  inverse(n - 1) = 0;
  for (Eigen::Index k = 0; k < by.value_by.size(); ++k) {
    const MatrixXd e = changed_by(by.parameters[std::size_t(k)], n);
    const VectorXd expected = vectors * inverse.asDiagonal() * vectors.transpose() * e * by.x;
    EXPECT_LT((by.minimiser_by.col(k) - expected).norm(), 1e-13);
  }
  EXPECT_GT(by.digits, 12);
}

TEST(MinimumDerivatives, OfSeveralEigenvectorsAreThoseOfPerturbationTheory) {
  const Eigen::Index n = 8, m = 3;
  const MatrixXd a = random_symmetric(n, 5);
  const Stiefel manifold(n, m);
  const Brockett f(SymmetricOperator::of(a), VectorXd::LinSpaced(m, 1, 3));
  const Point start = random_start(manifold, 2);
  const auto by = derivatives_from(manifold, f, start, "A");
  ASSERT_TRUE(by.strict()) << by.message;
  const auto [values, vectors] = symmetric_eigenvectors(a);
  for (Eigen::Index k = 0; k < by.value_by.size(); ++k) {
    const MatrixXd e = changed_by(by.parameters[std::size_t(k)], n);
    MatrixXd expected = MatrixXd::Zero(n, m);
    for (Eigen::Index c = 0; c < m; ++c)
      for (Eigen::Index j = 0; j < n; ++j) {
        const Eigen::Index own = m - 1 - c;  // the last column has the least eigenvalue
        if (j != own)
          expected.col(c) +=
              vectors.col(j) * vectors.col(j).dot(e * as_matrix(by.x, n).col(c)) / (values(own) - values(j));
      }
    EXPECT_LT((as_matrix(by.minimiser_by.col(k), n) - expected).norm(), 1e-12);
  }
  // Weights do not turn eigenvectors, and weigh eigenvalues.
  const auto by_weights = derivatives_from(manifold, f, start, "weights");
  EXPECT_LT(by_weights.minimiser_by.norm(), 1e-12);
  EXPECT_LT((by_weights.value_by.transpose() - values.head(m).reverse()).norm(), 1e-12);
}

/// -a^T x on the sphere: x* = a / |a|.
class Pull final : public ParametricObjective {
 public:
  explicit Pull(VectorXd a) : a_(std::move(a)) {}
  double evaluate(const Point& x, Vector& gradient) const override {
    gradient = -a_;
    return -a_.dot(x);
  }
  void hessian(const Point& x, const Vector&, Vector& h) const override { h.setZero(x.size()); }
  std::vector<ParameterTable> parameters() const override { return {{"a", a_.size()}}; }
  double parameter(const ParameterEntry& which) const override { return a_(which.row); }
  double by_parameter(const ParameterEntry& which, const Point& x, Vector& gradient) const override {
    gradient = -Vector::Unit(x.size(), which.row);
    return -x(which.row);
  }
  std::unique_ptr<ParametricObjective> changed(const ParameterEntry& which, double by) const override {
    auto out = std::make_unique<Pull>(a_);
    out->a_(which.row) += by;
    return out;
  }

 private:
  VectorXd a_;
};

TEST(MinimumDerivatives, OfAnObjectiveOfOnesOwn) {
  const VectorXd a = random_matrix(5, 1, 4);
  const Sphere sphere(5);
  const auto by = derivatives_from(sphere, Pull(a), random_start(sphere, 1), "a");
  ASSERT_TRUE(by.strict()) << by.message;
  const MatrixXd expected = (MatrixXd::Identity(5, 5) - a * a.transpose() / a.squaredNorm()) / a.norm();
  EXPECT_LT((by.minimiser_by - expected).norm(), 1e-14);
  EXPECT_LT((by.value_by.transpose() + a.normalized()).norm(), 1e-14);
}

TEST(MinimumDerivatives, HaveTheDigitsThatTheySay) {
  // Minimised to less and less, and not corrected.
  const Eigen::Index n = 12;
  const MatrixXd a = random_symmetric(n, 8);
  const Sphere sphere(n);
  const Rayleigh f(SymmetricOperator::of(a));
  const auto entries = entries_named(f.parameters(), "A");
  const auto best = derivatives_from(sphere, f, random_start(sphere, 3), "A");
  const double size = best.minimiser_by.colwise().norm().maxCoeff();
  for (const double off : {1e-3, 1e-7, 1e-9}) {
    Vector v = random_matrix(n, 1, 9);
    sphere.project(best.x, v);
    Point beside;
    ASSERT_TRUE(sphere.retract(ManifoldRetraction::exponential, best.x, off / v.norm() * v, beside));
    const auto rough = minimum_derivatives(sphere, f, beside, entries, {.corrections = 0});
    if (rough.status == MinimumStatus::not_critical) {
      EXPECT_EQ(off, 1e-3);
      continue;
    }
    const double error = (rough.minimiser_by - best.minimiser_by).colwise().norm().maxCoeff() / size;
    EXPECT_NEAR(rough.digits, -std::log10(error), 1) << off;
    const double of_value =
        (rough.value_by - best.value_by).cwiseAbs().maxCoeff() / best.value_by.cwiseAbs().maxCoeff();
    EXPECT_NEAR(rough.value_digits, -std::log10(of_value), 1) << off;
  }
}

TEST(MinimumDerivatives, OfAFitWithoutResidualVanishAndHaveTheDigitsOfTheirParts) {
  const Eigen::Index n = 4;
  const MatrixXd a = random_matrix(7, n, 1);
  const Stiefel group(n, n);
  const Point turned = random_start(group, 2);
  const MatrixXd image = a * as_matrix(turned, n);
  const auto derivatives = [&](double residual) {
    const Procrustes f(a, image + residual * random_matrix(7, n, 3));
    auto out = minimum_derivatives(group, f, turned, entries_named(f.parameters(), "B"));
    EXPECT_TRUE(out.strict()) << out.message;
    return out;
  };
  const auto exact = derivatives(0);
  EXPECT_TRUE(exact.value_is_at_rest());
  EXPECT_GT(exact.value_digits, 14);
  EXPECT_GT(exact.digits, 12);
  EXPECT_LT(exact.value_by.cwiseAbs().maxCoeff(), 10 * exact.value_error);
  EXPECT_GT(exact.value_error, 0);
  // What a residual leaves is a difference of numbers of the size one, and has as many digits less.
  for (const double residual : {1e-4, 1e-8, 1e-12}) {
    const auto near = derivatives(residual);
    EXPECT_FALSE(near.value_is_at_rest());
    EXPECT_NEAR(near.value_digits, 15.5 + std::log10(residual), 1) << residual;
  }
  // The minimiser does not depend on weights, which rounding does not take for derivatives without digits.
  const Brockett of_weights(SymmetricOperator::of(random_symmetric(6, 1)), Eigen::Vector2d(1, 2));
  const auto by = derivatives_from(Stiefel(6, 2), of_weights, random_start(Stiefel(6, 2), 1), "weights");
  EXPECT_LT(by.minimiser_by.norm(), 1e-13);
  EXPECT_GT(by.digits, 12);
}

TEST(MinimumDerivatives, OfLargeProblemsAreFreeOfMatrices) {
  const Eigen::Index n = 3000;
  const VectorXd w = VectorXd::LinSpaced(n, 0, 1).array().sqrt();
  const SymmetricOperator a{
      n, [w](const Eigen::Ref<const MatrixXd>& x, Eigen::Ref<MatrixXd> y) { y = w.asDiagonal() * x; }};
  const Brockett f(a, Eigen::Vector2d(1, 2));
  MatrixXd x = MatrixXd::Zero(n, 2);
  x(0, 1) = x(1, 0) = 1;
  const std::vector<ParameterEntry> by{{1, 0, 2}, {1, 0, 0}, {1, 5, 7}, {1, 0, 1}};
  const auto found = minimum_derivatives(Stiefel(n, 2), f, x.reshaped(), by);
  ASSERT_TRUE(found.strict()) << found.message;
  EXPECT_NEAR(found.value_by(1), 2, 1e-14);
  EXPECT_LT(std::abs(found.value_by(0)) + std::abs(found.value_by(2)), 1e-14);
  VectorXd turned = found.minimiser_by.col(0);
  EXPECT_NEAR(turned(n + 2), -1 / w(2), 1e-9 / w(2));
  turned(n + 2) = 0;
  EXPECT_LT(turned.norm(), 1e-9 / w(2));
  EXPECT_NEAR(found.minimiser_by(n + 1, 3), -1 / w(1), 1e-9 / w(1));
}

TEST(ParametricObjectives, SayHowTheyChange) {
  const HyperbolicSpace plane(2);
  const PositiveDefinite tensors(3);
  const Sphere sphere(4);
  std::vector<Point> near;
  for (unsigned i = 1; i < 4; ++i)
    near.push_back(VectorXd((VectorXd::Unit(4, 0) + 0.2 * random_matrix(4, 1, i)).normalized()));
  const auto positive = [] {
    MatrixXd a(3, 3);
    for (double& x : a.reshaped()) x = laws::draw_uniform();
    return Point((a * a.transpose() + 0.3 * MatrixXd::Identity(3, 3)).reshaped());
  };
  const auto beside_first = [] {
    Point x = VectorXd::Unit(4, 0);
    for (double& number : x) number += 0.2 * laws::draw_uniform();
    return x;
  };
  const auto weights = Eigen::Vector3d(1, 2, 0.5);
  std::vector<Point> there, matrices;
  for (unsigned i = 1; i < 4; ++i) {
    Point& point = there.emplace_back(random_matrix(3, 1, i));
    plane.nearest(point);
    const MatrixXd a = random_matrix(3, 3, i);
    matrices.emplace_back((a * a.transpose() + MatrixXd::Identity(3, 3)).reshaped());
  }
  const MatrixXd a = random_symmetric(6, 1);
  for (const auto& report :
       {laws::parametric_objective_laws(Sphere(6), Rayleigh(SymmetricOperator::of(a))),
        laws::parametric_objective_laws(Stiefel(6, 2), Brockett(SymmetricOperator::of(a), Eigen::Vector2d(1, 2))),
        laws::parametric_objective_laws(Stiefel(5, 2), Procrustes(random_matrix(7, 5, 1), random_matrix(7, 2, 2))),
        laws::parametric_objective_laws(plane, FrechetMean(plane, there, weights)),
        laws::parametric_objective_laws(tensors, FrechetMean(tensors, matrices, weights), positive),
        laws::parametric_objective_laws(sphere, FrechetMean(sphere, near, weights), beside_first),
        laws::parametric_objective_laws(sphere, Pull(random_matrix(4, 1, 1)))})
    EXPECT_TRUE(report.holds()) << report;
}

TEST(Logarithms, SayHowTheyChange) {
  std::vector<std::unique_ptr<Manifold>> factors;
  factors.push_back(std::make_unique<HyperbolicSpace>(2));
  factors.push_back(std::make_unique<Sphere>(3));
  const auto positive = [] {
    MatrixXd a(3, 3);
    for (double& x : a.reshaped()) x = laws::draw_uniform();
    return Point((a * a.transpose() + 0.3 * MatrixXd::Identity(3, 3)).reshaped());
  };
  for (const auto& report :
       {laws::logarithm_laws(Sphere(4)), laws::logarithm_laws(FlatSpace(3)), laws::logarithm_laws(HyperbolicSpace(3)),
        laws::logarithm_laws(PositiveDefinite(3), positive), laws::logarithm_laws(ProductManifold(std::move(factors)))})
    EXPECT_TRUE(report.holds()) << report;
}

TEST(Minima, ChangeByTheirDerivatives) {
  const HyperbolicSpace plane(2);
  std::vector<Point> there, matrices;
  for (unsigned i = 1; i < 4; ++i) {
    Point& point = there.emplace_back(random_matrix(3, 1, i));
    plane.nearest(point);
    const MatrixXd a = random_matrix(2, 2, i);
    matrices.emplace_back((a * a.transpose() + MatrixXd::Identity(2, 2)).reshaped());
  }
  const PositiveDefinite tensors(2);
  const FrechetMean in_plane(plane, there, Eigen::Vector3d(1, 2, 0.5));
  const FrechetMean of_tensors(tensors, matrices, Eigen::Vector3d(1, 2, 0.5));
  const MatrixXd a = random_symmetric(6, 1);
  const Brockett brockett(SymmetricOperator::of(a), Eigen::Vector2d(1, 2));
  const Procrustes procrustes(random_matrix(7, 4, 1), random_matrix(7, 2, 2));
  for (const auto& report : {laws::minimum_laws(Stiefel(6, 2), brockett, random_start(Stiefel(6, 2), 1), "A"),
                             laws::minimum_laws(Stiefel(6, 2), brockett, random_start(Stiefel(6, 2), 1), "weights.0"),
                             laws::minimum_laws(Stiefel(4, 2), procrustes, random_start(Stiefel(4, 2), 1), "A"),
                             laws::minimum_laws(Stiefel(4, 2), procrustes, random_start(Stiefel(4, 2), 1), "B"),
                             laws::minimum_laws(plane, in_plane, there.front(), "points"),
                             laws::minimum_laws(plane, in_plane, there.front(), "weights"),
                             laws::minimum_laws(tensors, of_tensors, matrices.front(), "points"),
                             laws::minimum_laws(tensors, of_tensors, matrices.front(), "weights")})
    EXPECT_TRUE(report.holds()) << report;
}

/// Rayleigh's quotient with slopes d_k D f that are not those of its gradients, although they are as symmetric.
class WrongSlopes final : public ParametricObjective {
 public:
  explicit WrongSlopes(std::shared_ptr<const ParametricObjective> f) : f_(std::move(f)) {}
  double evaluate(const Point& x, Vector& gradient) const override { return f_->evaluate(x, gradient); }
  void hessian(const Point& x, const Vector& v, Vector& h) const override { f_->hessian(x, v, h); }
  std::vector<ParameterTable> parameters() const override { return f_->parameters(); }
  double parameter(const ParameterEntry& which) const override { return f_->parameter(which); }
  double by_parameter(const ParameterEntry& which, const Point& x, Vector& gradient) const override {
    const double value = f_->by_parameter(which, x, gradient);
    gradient *= which.row == which.column ? 1 : 1.001;
    return value;
  }
  std::unique_ptr<ParametricObjective> changed(const ParameterEntry& which, double by) const override {
    return std::make_unique<WrongSlopes>(f_->changed(which, by));
  }

 private:
  std::shared_ptr<const ParametricObjective> f_;
};

TEST(MinimumLaws, DifferencesSeeAWrongSlopeThatIsSymmetric) {
  const Sphere sphere(6);
  const WrongSlopes f(std::make_shared<Rayleigh>(SymmetricOperator::of(random_symmetric(6, 1))));
  const auto of_minimum = laws::minimum_laws(sphere, f, VectorXd::Unit(6, 0), "A");
  EXPECT_TRUE(of_minimum.law("the least value changes by its derivative").holds()) << of_minimum;
  EXPECT_FALSE(of_minimum.law("the minimiser changes by its derivative").holds()) << of_minimum;
  const auto of_objective = laws::parametric_objective_laws(sphere, f);
  EXPECT_TRUE(of_objective.law("derivatives by parameters are those of the value").holds()) << of_objective;
  EXPECT_FALSE(of_objective.law("derivatives by parameters are those of the gradient").holds()) << of_objective;
}

TEST(NotStrictMinima, AreToldAndTheValueHasTheDerivativesThatThereAre) {
  // The least eigenvalue is double: it has a derivative by the entries that leave it so, to first order.
  const VectorXd w = (VectorXd(5) << 1, 1, 2, 3, 4).finished();
  const Brockett f(SymmetricOperator::of(MatrixXd(w.asDiagonal())), VectorXd::Ones(1));
  const Stiefel manifold(5, 1);
  const VectorXd x = (VectorXd(5) << 0.6, 0.8, 0, 0, 0).finished();
  const std::vector<ParameterEntry> by{{0, 0, 0}, {1, 2, 2}, {1, 2, 3}, {1, 0, 0}, {1, 0, 1}};
  const auto found = minimum_derivatives(manifold, f, x, by);
  EXPECT_EQ(found.status, MinimumStatus::not_strict);
  EXPECT_NE(found.message.find("not strict"), std::string::npos);
  EXPECT_NE(found.message.find("2 of 5"), std::string::npos) << found.message;
  EXPECT_NEAR(found.value_by(0), 1, 1e-14);
  EXPECT_NEAR(found.value_by(1), 0, 1e-14);
  EXPECT_NEAR(found.value_by(2), 0, 1e-14);
  EXPECT_FALSE(found.value_has(3) || found.value_has(4));
  EXPECT_TRUE(found.minimiser_by.array().isNaN().all());
}

TEST(NotStrictMinima, OfRotationsThatTheFunctionDoesNotSeeAreTold) {
  // Equal weights: any basis of the two eigenvectors will do.
  const MatrixXd a = random_symmetric(6, 4);
  const Stiefel manifold(6, 2);
  const Brockett f(SymmetricOperator::of(a), VectorXd::Ones(2));
  const auto by = derivatives_from(manifold, f, random_start(manifold, 1), "A");
  EXPECT_EQ(by.status, MinimumStatus::not_strict) << by.message;
  const MatrixXd v = symmetric_eigenvectors(a).vectors.leftCols(2);
  for (Eigen::Index k = 0; k < by.value_by.size(); ++k)
    EXPECT_NEAR(by.value_by(k), (v.transpose() * changed_by(by.parameters[std::size_t(k)], 6) * v).trace(), 1e-12);
  EXPECT_EQ(derivatives_from(manifold, f, random_start(manifold, 1), "weights").value_has(0), false);
}

TEST(NotStrictMinima, WhatIsNoneIsToldApart) {
  const MatrixXd a = random_symmetric(6, 4);
  const Sphere sphere(6);
  const Rayleigh f(SymmetricOperator::of(a));
  const auto entries = entries_named(f.parameters(), "A.0");
  const auto status = [&](const Manifold& manifold, const ParametricObjective& objective, const Point& x) {
    const auto found = minimum_derivatives(manifold, objective, x, entries);
    EXPECT_FALSE(found.message.empty());
    EXPECT_TRUE(found.value_by.array().isNaN().all());
    return found.status;
  };
  EXPECT_EQ(status(sphere, f, symmetric_eigenvectors(a).vectors.col(2)), MinimumStatus::no_minimum);
  EXPECT_EQ(status(sphere, f, 1.1 * VectorXd::Unit(6, 0)), MinimumStatus::not_finite);
  EXPECT_EQ(status(sphere, f, VectorXd::Unit(5, 0)), MinimumStatus::not_finite);
  EXPECT_EQ(status(sphere, f, VectorXd::Constant(6, std::nan(""))), MinimumStatus::not_finite);
  MatrixXd holed = a;
  holed(2, 3) = holed(3, 2) = std::nan("");
  EXPECT_EQ(status(sphere, Rayleigh(SymmetricOperator::of(holed)), VectorXd::Unit(6, 0)), MinimumStatus::not_finite);
  const auto sloping = minimum_derivatives(sphere, f, random_start(sphere, 5), entries, {.corrections = 0});
  EXPECT_EQ(sloping.status, MinimumStatus::not_critical);
  EXPECT_NE(sloping.message.find("minimise further"), std::string::npos);
}

TEST(NotStrictMinima, OfPointsWhoseLogarithmsAreNotKnownHaveNoMinimiser) {
  // Of a mean of rotations the value has its derivative by a point; how its logarithm changes is not written.
  const Stiefel group(3, 3);
  std::vector<Point> points;
  for (unsigned i = 1; i < 4; ++i) {
    Point& point = points.emplace_back((MatrixXd::Identity(3, 3) + 0.2 * random_matrix(3, 3, i)).reshaped());
    ASSERT_TRUE(group.nearest(point));
  }
  const FrechetMean f(group, points);
  const auto by = derivatives_from(group, f, points.front(), "points.1");
  EXPECT_TRUE(by.strict()) << by.message;
  EXPECT_NE(by.message.find("no slope of d_k f is known"), std::string::npos) << by.message;
  EXPECT_TRUE(by.value_by.allFinite());
  EXPECT_TRUE(by.minimiser_by.array().isNaN().all());
  EXPECT_TRUE(derivatives_from(group, f, points.front(), "weights").minimiser_by.allFinite());
}

TEST(ParameterNames, ChooseTablesRowsAndNumbers) {
  const std::vector<ParameterTable> tables{{"weights", 3}, {"A", 4, 4, true}, {"B", 2, 3}, {"c"}};
  EXPECT_EQ(entries_named(tables, "weights").size(), 3U);
  EXPECT_EQ(entries_named(tables, "weights.2"), (std::vector<ParameterEntry>{{0, 2, 0}}));
  EXPECT_EQ(entries_named(tables, "A").size(), std::size_t(tables[1].count()));
  EXPECT_EQ(entries_named(tables, "A.3").size(), 4U);
  EXPECT_EQ(entries_named(tables, "A.3.1"), entries_named(tables, "A.1.3"));
  EXPECT_EQ(entries_named(tables, "B.1").size(), 3U);
  EXPECT_EQ(entries_named(tables, "c"), (std::vector<ParameterEntry>{{3, 0, 0}}));
  for (const auto& [name, entry] :
       {std::pair("A.1.3", ParameterEntry{1, 1, 3}), std::pair("weights.2", ParameterEntry{0, 2, 0}),
        std::pair("c", ParameterEntry{3, 0, 0})})
    EXPECT_EQ(name_of(tables, entry), name);
  for (const char* none : {"D", "A.4", "A.1.", "A.1.4", "A.-1", "A.1.2.3", "weights.0.0", "", "B.x"})
    EXPECT_THROW(entries_named(tables, none), std::invalid_argument) << none;
}

}  // namespace
}  // namespace lagroid::optimisation::tests::minima_tests
