// Implicit integrators on Lie groups and homogeneous spaces: order conditions, measured orders, what they keep.
#include <lagroid/groupoids/groups/linear_fibre.hpp>
#include <lagroid/groupoids/groups/rotation_fibre.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/solvers/newton/crouch_grossman.hpp>
#include <lagroid/solvers/newton/lie_differentials.hpp>
#include <lagroid/systems/newton_examples.hpp>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

using namespace lagroid;

namespace solvers_crouch_grossman_tests {
namespace {

TEST(CrouchGrossman, CoefficientsSatisfyTheOrderConditions) {
  for (const auto& method : CrouchGrossman::all()) {
    const Eigen::VectorXd c = method.a.rowwise().sum();
    const Eigen::VectorXd& b = method.b;
    EXPECT_NEAR(b.sum(), 1, 1e-15) << method.name;
    if (method.order < 2) continue;
    EXPECT_NEAR(b.dot(c), 0.5, 1e-15) << method.name;
    if (method.order < 3) continue;
    EXPECT_NEAR(b.dot(c.cwiseProduct(c)), 1.0 / 3, 1e-15) << method.name;
    EXPECT_NEAR(b.dot(method.a * c), 1.0 / 6, 1e-15) << method.name;
    double brackets = 0;
    for (Eigen::Index i = 0; i < b.size(); ++i)
      for (Eigen::Index j = i + 1; j < b.size(); ++j) brackets += b(i) * b(j) * (c(j) - c(i));
    EXPECT_NEAR(brackets, 1.0 / 6, 1e-15) << method.name;
  }
}

/// y' = f(y) in a vector space, by the classical method of order 4.
Eigen::MatrixXd reference(const std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>& f, Eigen::MatrixXd y,
                          double horizon, int steps = 2000) {
  const double h = horizon / steps;
  for (int n = 0; n < steps; ++n) {
    const Eigen::MatrixXd k1 = f(y);
    const Eigen::MatrixXd k2 = f(y + h / 2 * k1);
    const Eigen::MatrixXd k3 = f(y + h / 2 * k2);
    const Eigen::MatrixXd k4 = f(y + h * k3);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return y;
}

template <class F, class Field>
typename F::Point integrate(const CrouchGrossman& method, const F& fibre, const Field& field, double horizon,
                            int steps) {
  LieIntegrator<F, Field> integrator(method, fibre, field);
  for (int n = 0; n < steps; ++n) EXPECT_TRUE(integrator.advance(horizon / steps).converged()) << method.name;
  return integrator.y();
}

/// The slope of the error over halved steps is the declared order.
template <class Error> void expect_declared_order(const CrouchGrossman& method, const Error& error, int steps) {
  const double slope = std::log2(error(2 * steps) / error(4 * steps));
  EXPECT_NEAR(slope, method.order, 0.1) << method.name;
}

TEST(CrouchGrossman, OrdersOnOrthogonalGroups) {
  for (const auto& method : CrouchGrossman::all())
    for (const auto which : {NewtonExample::first, NewtonExample::second})
      for (const Eigen::Index n : {3, 5}) {
        const double horizon = which == NewtonExample::first ? 1 : 0.1;
        const Eigen::MatrixXd start = random_orthogonal(n, 3);
        const ExampleField field(which);
        const Eigen::MatrixXd exact = reference(
            [&](const Eigen::MatrixXd& y) -> Eigen::MatrixXd { return y * skew(field.g(y), n); }, start, horizon);
        expect_declared_order(
            method,
            [&](int steps) { return (integrate(method, RotationFibre(start), field, horizon, steps) - exact).norm(); },
            8);
        const Eigen::MatrixXd end = integrate(method, RotationFibre(start), field, horizon, 8);
        EXPECT_LT((end.transpose() * end - Eigen::MatrixXd::Identity(n, n)).norm(), 1e-14);
        EXPECT_NEAR(end.determinant(), start.determinant(), 1e-14);
      }
}

TEST(CrouchGrossman, OrdersOnTheSpecialLinearGroup) {
  const LinearFibre fibre(Eigen::MatrixXd{{1, 0.2, 0}, {0, 1, -0.3}, {0.1, 0, 1}}, LinearFibre::Determinant::kept);
  const auto velocity = [](const auto& y) {
    using S = typename std::decay_t<decltype(y)>::Scalar;
    Eigen::VectorX<S> out(8);
    for (int i = 0; i < 8; ++i) out(i) = sin(y((i * 4 + 1) % 9) + 0.3 * double(i)) * 0.5;
    return out;
  };
  const AutomaticField field(fibre, velocity);
  const Eigen::MatrixXd exact = reference(
      [&](const Eigen::MatrixXd& y) -> Eigen::MatrixXd { return y * fibre.hat(field.g(y)); }, fibre.centre(), 1.0);
  for (const auto& method : CrouchGrossman::all()) {
    expect_declared_order(
        method, [&](int steps) { return (integrate(method, fibre, field, 1.0, steps) - exact).norm(); }, 8);
    EXPECT_NEAR(integrate(method, fibre, field, 1.0, 8).determinant(), fibre.centre().determinant(), 1e-13);
  }
}

TEST(CrouchGrossman, TheMidpointRuleIsSymmetricAndOthersAreNot) {
  for (const auto& method : CrouchGrossman::all()) {
    const Eigen::MatrixXd start = random_orthogonal(4, 3);
    LieIntegrator integrator(method, RotationFibre(start), ExampleField(NewtonExample::first));
    ASSERT_TRUE(integrator.advance(0.3).converged());
    ASSERT_TRUE(integrator.advance(-0.3).converged());
    const double gap = (integrator.y() - start).norm();
    if (method.symmetric) {
      EXPECT_LT(gap, 1e-14) << method.name;
    } else {
      EXPECT_GT(gap, 1e-6) << method.name;
    }
  }
}

TEST(CrouchGrossman, OrdersOnASphereThroughTheActionGroupoid) {
  // Euler's equations m' = m x I^{-1} m: m turns by xi(m) = I^{-1} m.
  using G = Action<SO3, RotatedVectors>;
  const Vector<double, 3> start(0.4, -0.8, 0.7);
  const auto xi = [](const auto& arrow) {
    const auto m = G::target(arrow);
    using S = typename std::decay_t<decltype(m)>::Scalar;
    return Vector<S, 3>(m(0) * 1.4, m(1) * 0.7, m(2) * 0.5);
  };
  const GroupoidFibre<G> fibre(G().unit(start));
  const AutomaticField field(fibre, xi);
  const Eigen::MatrixXd exact = reference(
      [](const Eigen::MatrixXd& m) -> Eigen::MatrixXd {
        const Eigen::Vector3d p = m;
        return p.cross(Eigen::Vector3d(1.4 * p(0), 0.7 * p(1), 0.5 * p(2)));
      },
      start, 3.0);
  for (const auto& method : CrouchGrossman::all()) {
    const auto end = [&](int steps) { return Eigen::Vector3d(G::target(integrate(method, fibre, field, 3.0, steps))); };
    expect_declared_order(
        method, [&](int steps) { return (end(steps) - exact).norm(); }, 16);
    EXPECT_NEAR(end(16).norm(), start.norm(), 1e-14) << "it stays on the sphere";
  }
}

TEST(CrouchGrossman, FlowsOfSymmetricMatricesKeepTheirSpectrum) {
  // Toda: L' = [L, B(L)] with B(L) the skew part below and above the diagonal; L = y^T L0 y, y' = y B(L).
  const Eigen::Index n = 5;
  const Eigen::MatrixXd q = random_orthogonal(n, 8);
  const Eigen::MatrixXd start = q * Eigen::VectorXd::LinSpaced(n, -1, 2).asDiagonal() * q.transpose();
  const auto b = [&](const auto& y) {
    using S = typename std::decay_t<decltype(y)>::Scalar;
    const Eigen::MatrixX<S> l = y.transpose() * start.cast<S>() * y;
    Eigen::VectorX<S> out(n * (n - 1) / 2);
    for (Eigen::Index r = 0, i = 0; r < n; ++r)
      for (Eigen::Index c = r + 1; c < n; ++c) out(i++) = -l(r, c);
    return out;
  };
  const RotationFibre fibre(Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n)));
  const AutomaticField field(fibre, b);
  const Eigen::MatrixXd exact = reference(
      [&](const Eigen::MatrixXd& l) -> Eigen::MatrixXd {
        Eigen::MatrixXd x = Eigen::MatrixXd::Zero(n, n);
        x.triangularView<Eigen::StrictlyUpper>() = -l;
        x -= x.transpose().eval();
        return l * x - x * l;
      },
      start, 1.0);
  for (const auto& method : CrouchGrossman::all()) {
    const auto end = [&](int steps) -> Eigen::MatrixXd {
      const Eigen::MatrixXd y = integrate(method, fibre, field, 1.0, steps);
      return y.transpose() * start * y;
    };
    expect_declared_order(
        method, [&](int steps) { return (end(steps) - exact).norm(); }, 16);
    const Eigen::VectorXd spectrum = end(16).selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_LT((spectrum - Eigen::VectorXd::LinSpaced(n, -1, 2)).norm(), 1e-13);
  }
}

TEST(CrouchGrossman, AStepThatFailsAdvancesNothing) {
  ArclengthOptions none;
  none.max_steps = 1;
  none.tolerance = 0;
  const Eigen::MatrixXd start = random_orthogonal(8, 0);
  LieIntegrator integrator(CrouchGrossman::implicit_euler(), RotationFibre(start), ExampleField(NewtonExample::first),
                           none);
  const auto report = integrator.advance(500);
  EXPECT_EQ(report.status, SolveStatus::not_converged);
  EXPECT_EQ(integrator.y(), start);
}

TEST(CrouchGrossman, MethodsThatAreNotTriangularAreRefused) {
  CrouchGrossman gauss = CrouchGrossman::dirk2();
  gauss.a(0, 1) = 0.1;
  EXPECT_THROW(LieIntegrator(gauss, RotationFibre(random_orthogonal(3, 0)), ExampleField(NewtonExample::first)),
               std::invalid_argument);
  EXPECT_THROW(RotationFibre(Eigen::MatrixXd(2 * random_orthogonal(3, 0))), std::invalid_argument);
}

TEST(CrouchGrossman, ExplicitStagesAreTakenAndFailWhereTheyAreNotFinite) {
  const CrouchGrossman euler{"explicit Euler", 1, false, Eigen::MatrixXd{{0}}, Eigen::VectorXd{{1}}};
  const Eigen::MatrixXd start = random_orthogonal(3, 0);
  const ExampleField field(NewtonExample::first);
  LieIntegrator integrator(euler, RotationFibre(start), field);
  EXPECT_EQ(integrator.advance(std::numeric_limits<double>::infinity()).status, SolveStatus::not_finite);
  EXPECT_EQ(integrator.y(), start);
  EXPECT_TRUE(integrator.advance(0.1).converged());
  EXPECT_LT((integrator.y() - RotationFibre(start).at(0.1 * field.g(start))).norm(), 1e-15);
}

TEST(CrouchGrossman, StepsOfAnySizeAreTaken) {
  LieIntegrator integrator(CrouchGrossman::dirk3(), RotationFibre(random_orthogonal(6, 1)),
                           ExampleField(NewtonExample::first));
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(integrator.advance(100).converged());
}

}  // namespace
}  // namespace solvers_crouch_grossman_tests
