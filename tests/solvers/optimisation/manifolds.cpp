// Laws of manifolds and objectives, and the geometry of curvature.
#include "instances.hpp"

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
#include <string>
#include <vector>

namespace lagroid::optimisation::tests {
namespace {

ProductManifold product() {
  std::vector<std::unique_ptr<Manifold>> factors;
  factors.push_back(std::make_unique<Sphere>(3));
  factors.push_back(std::make_unique<Stiefel>(4, 2));
  return ProductManifold(std::move(factors));
}

TEST(ManifoldLaws, Hold) {
  for (const auto& report :
       {laws::manifold_laws(Sphere(5)), laws::manifold_laws(Stiefel(6, 3)), laws::manifold_laws(Stiefel(4, 4)),
        laws::manifold_laws(Stiefel(5, 1)), laws::manifold_laws(product())}) {
    for (const laws::Law& law : report.laws)
      // No closed form for m < n.
      EXPECT_TRUE(law.holds() || law.name == "the logarithm inverts the exponential") << report;
  }
  EXPECT_TRUE(laws::manifold_laws(Sphere(5)).law("the logarithm inverts the exponential").holds());
  EXPECT_TRUE(laws::manifold_laws(Stiefel(4, 4)).law("the logarithm inverts the exponential").holds());
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

class Misread final : public Objective {
 public:
  double evaluate(const Point& x, Vector& gradient) const override {
    gradient = 1.01 * x.array().cos();
    return x.array().sin().sum();
  }
  void hessian(const Point& x, const Vector& v, Vector& h) const override { h = x.array().sin() * v.array(); }
  std::optional<double> lipschitz() const override { return 1e-3; }
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
}  // namespace lagroid::optimisation::tests
