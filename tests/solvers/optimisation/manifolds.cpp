// Laws of manifolds and objectives, and the geometry of curvature.
#include "instances.hpp"

#include <lagroid/solvers/optimisation/manifolds/flat.hpp>
#include <lagroid/solvers/optimisation/manifolds/hyperbolic_space.hpp>
#include <lagroid/solvers/optimisation/manifolds/positive_definite.hpp>
#include <lagroid/solvers/optimisation/manifolds/product.hpp>
#include <lagroid/solvers/optimisation/manifolds/sphere.hpp>
#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>
#include <lagroid/solvers/optimisation/testing/manifold_laws.hpp>
#include <lagroid/systems/optimisation/instances.hpp>
#include <lagroid/systems/optimisation/procrustes.hpp>
#include <lagroid/systems/optimisation/random.hpp>
#include <lagroid/systems/optimisation/rayleigh.hpp>

#include "../../support/broken.hpp"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::optimisation::tests::manifolds_tests {
namespace {

ProductManifold product() {
  std::vector<std::unique_ptr<Manifold>> factors;
  factors.push_back(std::make_unique<Sphere>(3));
  factors.push_back(std::make_unique<Stiefel>(4, 2));
  return ProductManifold(std::move(factors));
}

/// The product of a manifold with a metric of its own and one without.
ProductManifold mixed_product() {
  std::vector<std::unique_ptr<Manifold>> factors;
  factors.push_back(std::make_unique<HyperbolicSpace>(2));
  factors.push_back(std::make_unique<Sphere>(3));
  return ProductManifold(std::move(factors));
}

/// A A^T + 1/10.
Point draw_positive(Eigen::Index n) {
  MatrixXd a(n, n);
  for (double& x : a.reshaped()) x = laws::draw_uniform();
  a = a * a.transpose() + 0.1 * MatrixXd::Identity(n, n);
  return a.reshaped();
}

TEST(ManifoldLaws, Hold) {
  for (const auto& report :
       {laws::manifold_laws(Sphere(5)), laws::manifold_laws(Stiefel(4, 4)), laws::manifold_laws(FlatSpace(4)),
        laws::manifold_laws(HyperbolicSpace(1)), laws::manifold_laws(HyperbolicSpace(4)),
        laws::manifold_laws(mixed_product()), laws::manifold_laws(PositiveDefinite(1), [] { return draw_positive(1); }),
        laws::manifold_laws(PositiveDefinite(3), [] { return draw_positive(3); })})
    EXPECT_TRUE(report.holds()) << report;
  for (const auto& report :
       {laws::manifold_laws(Stiefel(6, 3)), laws::manifold_laws(Stiefel(5, 1)), laws::manifold_laws(product())})
    for (const laws::Law& law : report.laws)
      // No closed form for m < n.
      EXPECT_TRUE(law.holds() || law.skipped_because.ends_with("not known in closed form")) << report;
}

/// The sphere with one operation replaced.
class BrokenSphere : public Manifold {
 public:
  std::string name() const override { return "broken"; }
  Eigen::Index size() const override { return sphere_.size(); }
  Eigen::Index dimension() const override { return sphere_.dimension(); }
  double residual(const Point& x) const override { return sphere_.residual(x); }
  double penalty(const Point& x, double weight, Vector& gradient) const override {
    return 2 * sphere_.penalty(x, weight, gradient);
  }
  bool nearest(Point& x) const override { return sphere_.nearest(x); }
  void project(const Point& x, Vector& v) const override { v -= 0.9 * x.dot(v) * x; }
  double inner(const Point&, const Vector& u, const Vector& v) const override { return u.dot(v) + u(0) * v(1); }
  bool offers(ManifoldRetraction) const override { return true; }
  bool retract(ManifoldRetraction, const Point& x, const Vector& v, Point& to) const override {
    to = x + 1.1 * v;
    return true;
  }
  bool orthographic(const Point& x, const Vector& z, Point& to, Vector& moved) const override {
    to = (x + z).normalized();
    moved = to - x;
    return true;
  }
  double reach(const Vector& v) const override { return v.norm(); }
  bool logarithm(const Point& x, const Point& y, Vector& v) const override {
    v = y - x;
    return true;
  }
  bool parallel_transport(const Point&, const Point& to, Vector& v) const override {
    v *= 1.1 + to(0);
    return true;
  }
  void hessian(const Point& x, const Vector&, const Vector&, Vector& h) const override { sphere_.project(x, h); }
  double least_curvature() const override { return 1; }
  double diameter() const override { return 3; }

 private:
  Sphere sphere_{5};
};

TEST(ManifoldLaws, FailOnABrokenManifold) {
  const auto report = laws::manifold_laws(BrokenSphere());
  for (const laws::Law& law : report.laws)
    EXPECT_EQ(laws::seen_broken(law), law.name != "nearest points lie on it") << report;
}

/// The hyperbolic plane with one fault.
enum class Fault { none, metric, gradient, projected_transport, turned_transport, hessian, curvature };
class FaultyPlane final : public Manifold {
 public:
  explicit FaultyPlane(Fault fault) : fault_(fault) {}

  std::string name() const override { return "faulty"; }
  Eigen::Index size() const override { return plane_.size(); }
  Eigen::Index dimension() const override { return plane_.dimension(); }
  double residual(const Point& x) const override { return plane_.residual(x); }
  double penalty(const Point& x, double weight, Vector& gradient) const override {
    return plane_.penalty(x, weight, gradient);
  }
  bool nearest(Point& x) const override { return plane_.nearest(x); }
  void project(const Point& x, Vector& v) const override { plane_.project(x, v); }
  bool has_own_metric() const override { return true; }
  /// At fault that of Minkowski times x_0^2, which curves otherwise.
  double inner(const Point& x, const Vector& u, const Vector& v) const override {
    return plane_.inner(x, u, v) * (fault_ == Fault::metric ? x(0) * x(0) : 1);
  }
  void gradient(const Point& x, Vector& differential) const override {
    if (fault_ == Fault::gradient)
      project(x, differential);
    else
      plane_.gradient(x, differential);
  }
  void differential(const Point& x, Vector& gradient) const override { plane_.differential(x, gradient); }
  bool offers(ManifoldRetraction retraction) const override { return plane_.offers(retraction); }
  bool retract(ManifoldRetraction retraction, const Point& x, const Vector& v, Point& to) const override {
    return plane_.retract(retraction, x, v, to);
  }
  bool logarithm(const Point& x, const Point& y, Vector& v) const override { return plane_.logarithm(x, y, v); }
  bool parallel_transport(const Point& from, const Point& to, Vector& v) const override {
    if (fault_ == Fault::projected_transport) {
      project(to, v);
      return true;
    }
    if (!plane_.parallel_transport(from, to, v)) return false;
    if (fault_ != Fault::turned_transport) return true;
    // An isometry still.
    Vector along;
    Vector across(3);
    plane_.logarithm(from, to, along);
    const double distance = plane_.norm(from, along);
    const double angle = distance * (1 + distance);
    across << 0, -to(2), to(1);
    Vector outwards(3);
    outwards << to.tail(2).squaredNorm() / to(0), to.tail(2);
    outwards /= plane_.norm(to, outwards);
    across /= plane_.norm(to, across);
    const double a = plane_.inner(to, v, outwards);
    const double b = plane_.inner(to, v, across);
    v = (a * std::cos(angle) - b * std::sin(angle)) * outwards + (a * std::sin(angle) + b * std::cos(angle)) * across;
    return true;
  }
  void hessian(const Point& x, const Vector& gradient, const Vector& v, Vector& h) const override {
    if (fault_ == Fault::hessian)
      this->gradient(x, h);
    else
      plane_.hessian(x, gradient, v, h);
  }
  double least_curvature() const override { return fault_ == Fault::curvature ? -0.9 : plane_.least_curvature(); }
  double diameter() const override { return plane_.diameter(); }

 private:
  Fault fault_;
  HyperbolicSpace plane_{2};
};

TEST(ManifoldLaws, FailOnFaultsOfAMetric) {
  EXPECT_TRUE(laws::manifold_laws(FaultyPlane(Fault::none)).holds());
  for (const auto& [fault, law] :
       {std::pair(Fault::metric, "the gradient is that of the metric"),
        {Fault::metric, "curvatures are not below their bound"},
        {Fault::gradient, "the gradient is that of the metric"},
        {Fault::projected_transport, "parallel transport is an isometry that carries geodesics along"},
        {Fault::turned_transport, "parallel transport goes on along a geodesic"},
        {Fault::projected_transport, "gradients change along transported vectors by the Hessian"},
        {Fault::hessian, "the Hessian is the second derivative along geodesics"},
        {Fault::curvature, "curvatures are not below their bound"}}) {
    const auto report = laws::manifold_laws(FaultyPlane(fault));
    EXPECT_TRUE(laws::seen_broken(report.law(law))) << law << report;
  }
}

class Misread final : public Objective {
 public:
  double evaluate(const Point& x, Vector& gradient) const override {
    gradient = 1.01 * x.array().cos();
    return x.array().sin().sum();
  }
  void hessian(const Point& x, const Vector& v, Vector& h) const override { h = x.array().sin() * v.array(); }
  std::optional<double> lipschitz() const override { return 1e-3; }
  bool convex() const override { return true; }
};

TEST(ObjectiveLaws, Hold) {
  const auto a = SymmetricOperator::of(random_symmetric(6, 1));
  const Rayleigh rayleigh(a);
  const Brockett brockett(a, VectorXd::LinSpaced(3, 1, 3));
  const Procrustes procrustes(random_matrix(7, 6, 2), random_matrix(7, 3, 3));
  for (const auto& report : {laws::objective_laws(Sphere(6), rayleigh), laws::objective_laws(Stiefel(6, 3), brockett),
                             laws::objective_laws(Stiefel(6, 3), procrustes)})
    EXPECT_TRUE(report.holds()) << report;
  const auto broken = laws::objective_laws(Sphere(6), Misread());
  for (const laws::Law& law : broken.laws) EXPECT_TRUE(laws::seen_broken(law)) << broken;
}

TEST(Zeta, IsThatOfTheCurvature) {
  EXPECT_EQ(zeta(1, 3), 1);
  EXPECT_EQ(zeta(0, 3), 1);
  EXPECT_NEAR(zeta(-4, 1.5), 3 / std::tanh(3.0), 1e-15);
  EXPECT_NEAR(zeta(-1e-12, 1), 1 + 1e-12 / 3, 1e-16);
  // Of a manifold: by its diameter, or that of the domain.
  EXPECT_EQ(zeta(Sphere(4), 0), 1);
  EXPECT_EQ(zeta(HyperbolicSpace(1), 0), 1);
  EXPECT_EQ(zeta(HyperbolicSpace(3), 2), zeta(-1, 2));
  EXPECT_EQ(zeta(PositiveDefinite(3), 2), zeta(-0.5, 2));
  EXPECT_EQ(zeta(Stiefel(5, 2), 0), zeta(-0.5, Stiefel(5, 2).diameter()));
  EXPECT_EQ(zeta(Stiefel(5, 2), 100), zeta(-0.5, Stiefel(5, 2).diameter()));
  EXPECT_THROW(zeta(HyperbolicSpace(3), 0), std::invalid_argument);
  // The bound that the Stiefel manifold declares holds, and is attained: K = Trace(U^T U V^T V) - |sym(U^T V)|^2.
  const auto curvature = [](const Vector& u, const Vector& v) {
    const MatrixXd p = as_matrix(u, 5);
    const MatrixXd q = as_matrix(v, 5);
    const MatrixXd s = 0.5 * (p.transpose() * q + q.transpose() * p);
    return (p.transpose() * p * q.transpose() * q).trace() - s.squaredNorm();
  };
  const Stiefel manifold(5, 2);
  const MatrixXd x = as_matrix(random_start(manifold, 1), 5);
  VectorXd across = VectorXd::Unit(5, 0) - x * x.row(0).transpose();
  across.normalize();
  Vector one = Vector::Zero(10);
  Vector other = Vector::Zero(10);
  one.head(5) = across;
  other.tail(5) = across;
  EXPECT_NEAR(curvature(one, other), manifold.least_curvature(), 1e-15);
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Point at = random_start(manifold, seed);
    Vector u = random_matrix(10, 1, seed + 1000);
    Vector v = random_matrix(10, 1, seed + 2000);
    manifold.project(at, u);
    manifold.project(at, v);
    u.normalize();
    v -= u.dot(v) * u;
    v.normalize();
    EXPECT_GE(curvature(u, v), manifold.least_curvature());
  }
}

}  // namespace
}  // namespace lagroid::optimisation::tests::manifolds_tests
