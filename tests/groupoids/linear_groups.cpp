// GL(n) and SL(n): where exp has an inverse, where not, and what Newton's iteration says of it.
#include <lagroid/groupoids/groups/linear.hpp>
#include <lagroid/groupoids/groups/linear_fibre.hpp>
#include <lagroid/solvers/newton/lie_differentials.hpp>
#include <lagroid/solvers/step/arclength.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace lagroid;

namespace groupoids_linear_groups_tests {
namespace {

using Determinant = LinearFibre::Determinant;

Eigen::VectorXd random_vector(Eigen::Index n, double size, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0, size);
  return Eigen::VectorXd::NullaryExpr(n, [&] { return normal(generator); });
}

LinearFibre at_identity(Eigen::Index n, Determinant determinant) {
  return {Eigen::MatrixXd::Identity(n, n), determinant};
}

TEST(LinearFibre, LogInvertsExpAndDexpIsItsDifferential) {
  for (const auto determinant : {Determinant::any, Determinant::kept})
    for (const Eigen::Index n : {2, 3, 5, 8})
      for (const double size : {1e-6, 1e-2, 0.3}) {
        const LinearFibre fibre = at_identity(n, determinant);
        const Eigen::VectorXd v = random_vector(fibre.dimension(), size, unsigned(n));
        const auto back = fibre.coordinates(fibre.at(v));
        ASSERT_TRUE(back.has_value());
        EXPECT_LT((*back - v).norm(), 1e-13 * (1 + v.norm())) << n << ' ' << size;
        if (determinant == Determinant::kept) {
          EXPECT_NEAR(fibre.at(v).determinant(), 1, 1e-13);
        }
        const Eigen::VectorXd u = random_vector(fibre.dimension(), 1, 3);
        const double t = 1e-5;
        const Eigen::MatrixXd quotient = fibre.at(-v) * (fibre.at(v + t * u) - fibre.at(v - t * u)) / (2 * t);
        EXPECT_LT((quotient - fibre.hat(fibre.dtau(v) * u)).norm(), 1e-7 * (1 + u.norm()));
        EXPECT_LT((fibre.dtau_inverse(v) * fibre.dtau(v) * u - u).norm(), 1e-12 * u.norm());
      }
}

TEST(LinearFibre, MatricesWithoutAPrincipalLogarithmAreRefused) {
  const auto refused = [](const Eigen::MatrixXd& y, Determinant determinant) {
    return !at_identity(y.rows(), determinant).coordinates(y).has_value();
  };
  EXPECT_TRUE(refused(Eigen::Vector2d(-1, -2).asDiagonal(), Determinant::any));
  EXPECT_TRUE(refused(Eigen::Vector2d(-2, -0.5).asDiagonal(), Determinant::kept));
  EXPECT_TRUE(refused(Eigen::Vector3d(1, 2, 0).asDiagonal(), Determinant::any)) << "singular";
  EXPECT_TRUE(refused(Eigen::Matrix2d{{-1, 1}, {0, -1}}, Determinant::kept)) << "no logarithm at all in SL(2)";
  EXPECT_FALSE(refused(Eigen::Vector2d(1e-3, 1e3).asDiagonal(), Determinant::kept));
}

TEST(LinearGroups, OfFixedSizeAreThoseOfRunTimeSize) {
  const Eigen::VectorXd x = random_vector(9, 0.4, 1);
  const LinearFibre general = at_identity(3, Determinant::any);
  const Vector<double, 9> v = x;
  EXPECT_LT((Linear<3>::exp(v) - general.at(x)).norm(), 1e-14);
  EXPECT_LT((Linear<3>::log(Linear<3>::exp(v)) - v).norm(), 1e-14);
  EXPECT_LT((GroupoidFibre<Linear<3>>(Linear<3>::exp(v)).dtau(v) - general.dtau(x)).norm(), 1e-13);
  EXPECT_LT((Linear<3>::ad(v) - general.ad(x)).norm(), 1e-15);
  const LinearFibre special = at_identity(3, Determinant::kept);
  const Vector<double, 8> w = x.head(8);
  EXPECT_LT((SpecialLinear<3>::exp(w) - special.at(w)).norm(), 1e-14);
  EXPECT_NEAR(SpecialLinear<3>::exp(w).determinant(), 1, 1e-14);
  EXPECT_FALSE(SpecialLinear<2>::log(Matrix<double, 2, 2>(Eigen::Vector2d(-2, -0.5).asDiagonal())).allFinite());
  // Small and large.
  for (const double size : {1e-12, 1e-3, 3.0}) {
    const Vector<double, 4> s = size * Vector<double, 4>(0.3, -0.5, 0.2, 0.4);
    EXPECT_LT((Linear<2>::log(Linear<2>::exp(s)) - s).norm(), 1e-15 + 1e-14 * s.norm()) << size;
  }
}

TEST(LinearGroups, LogarithmsNearTheNegativeAxisAreRightOrNone) {
  int refused = 0;
  for (const double off : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
    const double angle = M_PI - off;
    Matrix<double, 4, 4> g;  // two equal pairs of eigenvalues, not diagonalisable
    g << std::cos(angle), -std::sin(angle), 1, 0, std::sin(angle), std::cos(angle), 0, 1, 0, 0, std::cos(angle),
        -std::sin(angle), 0, 0, std::sin(angle), std::cos(angle);
    const Vector<double, 16> x = Linear<4>::log(g);
    if (x.allFinite()) {
      EXPECT_LT((Linear<4>::exp(x) - g).norm(), 1e-10) << off;
    } else {
      ++refused;
    }
    EXPECT_TRUE(at_identity(4, Determinant::any).coordinates(g).has_value()) << off;
  }
  EXPECT_LT(refused, 5);
  const Matrix<double, 2, 2> large = 1e100 * Matrix<double, 2, 2>::Identity();
  EXPECT_NEAR(Linear<2>::log(large)(0), std::log(1e100), 1e-10);
  EXPECT_FALSE(at_identity(2, Determinant::kept).coordinates(2 * Eigen::Matrix2d::Identity()).has_value())
      << "not of the same determinant";
}

/// y = z exp(h g(y)) with g(y) = y^T y - 1 and its like of trace zero.
template <class Fibre> struct Stretch {
  Fibre fibre;
  Eigen::VectorXd g(const Eigen::MatrixXd& y) const { return of(Eigen::MatrixXd(y.transpose() * y)); }
  Eigen::MatrixXd dg(const Eigen::MatrixXd& y) const {
    Eigen::MatrixXd out(fibre.dimension(), fibre.dimension());
    for (Eigen::Index i = 0; i < out.cols(); ++i) {
      const Eigen::MatrixXd change = y * fibre.hat(Eigen::VectorXd::Unit(out.cols(), i));
      out.col(i) = of(Eigen::MatrixXd(change.transpose() * y + y.transpose() * change));
    }
    return out;
  }
  Eigen::VectorXd of(const Eigen::MatrixXd& s) const {
    const Eigen::Index n = s.rows();
    const double trace = fibre.dimension() == n * n ? 0 : s.trace() / double(n);
    const Eigen::MatrixXd x = s - trace * Eigen::MatrixXd::Identity(n, n);
    return x.reshaped().head(fibre.dimension());
  }
};

TEST(LinearGroups, NewtonSolvesImplicitStepsOnThem) {
  for (const auto determinant : {Determinant::any, Determinant::kept})
    for (const auto iteration : {LieIteration::version1, LieIteration::version1_by_chart, LieIteration::version2}) {
      const LinearFibre fibre(
          Eigen::MatrixXd::Identity(4, 4) + 0.2 * Eigen::MatrixXd(random_vector(16, 1, 8).reshaped(4, 4)), determinant);
      const ImplicitStep step{fibre, Stretch<LinearFibre>{fibre}, -0.1};
      LieNewtonOptions options;
      options.iteration = iteration;
      std::vector<double> r;
      const auto result = lie_newton(step, Eigen::VectorXd::Zero(fibre.dimension()), options,
                                     [&](double residual) { r.push_back(residual); });
      ASSERT_TRUE(result.converged()) << to_string(result.status);
      EXPECT_LT((result.y - fibre.at(-0.1 * step.field().g(result.y))).norm(), 1e-12);
      ASSERT_GE(r.size(), 4U);
      EXPECT_LT(r[r.size() - 2], 1e-4);
      if (determinant == Determinant::kept) {
        EXPECT_NEAR(result.y.determinant(), fibre.centre().determinant(), 1e-12);
      }
    }
}

/// f = v - u for an u whose first update goes beyond the logarithm.
struct HalfTurn {
  using Fibre = LinearFibre;
  Fibre fibre_ = at_identity(2, Determinant::any);
  Eigen::VectorXd goal;
  const Fibre& fibre() const { return fibre_; }
  Eigen::VectorXd residual(const Eigen::MatrixXd&, const Eigen::VectorXd& v) const { return v - goal; }
  Eigen::MatrixXd differential(const Eigen::MatrixXd&, const Eigen::VectorXd& v) const {
    return fibre_.dtau_inverse(v);
  }
  Eigen::MatrixXd chart_differential(const Eigen::MatrixXd&, const Eigen::VectorXd&) const {
    return Eigen::MatrixXd::Identity(4, 4);
  }
  double norm(const Eigen::VectorXd& f) const { return f.norm(); }
};
TEST(LinearGroups, LeavingTheReachOfExpIsTyped) {
  // Half a turn, whose exponential is -I.
  HalfTurn equation;
  equation.goal = Eigen::Vector4d(0, M_PI, -M_PI, 0);
  LieNewtonOptions options;
  options.max_iterations = 1;
  const auto result = lie_newton(equation, Eigen::VectorXd::Zero(4), options);
  EXPECT_EQ(result.status, SolveStatus::left_domain) << to_string(result.status);
  options.iteration = LieIteration::version2;
  EXPECT_TRUE(lie_newton(equation, Eigen::VectorXd::Zero(4), options).converged()) << "version 2 needs no logarithm";
}

}  // namespace
}  // namespace groupoids_linear_groups_tests
