// The two versions of Newton's method on Lie groups: where they agree, and by how much they differ.
#include "examples.hpp"

#include <lagroid/groupoids/groups/linear.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/systems/newton_examples.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lagroid::lie_newton_tests::versions_tests {
namespace {

TEST(LieNewton, BothVersionsFindTheSameSolution) {
  const Step step = example(NewtonExample::first, 6, 3, 0.5);
  LieNewtonOptions chart;
  chart.iteration = LieIteration::version2;
  const auto one = lie_newton(step, zero(step));
  const auto two = lie_newton(step, zero(step), chart);
  ASSERT_TRUE(one.converged() && two.converged());
  EXPECT_LT((one.y - two.y).norm(), 1e-12);
}

TEST(LieNewton, Theorem32TheVersionsDifferByTheSquareOfTheUpdate) {
  // One iteration from v with f(v) = O(eps): the updates are O(eps), their difference O(eps^2).
  const Step step = example(NewtonExample::first, 5, 2, 0.5);
  const auto solution = lie_newton(step, zero(step));
  ASSERT_TRUE(solution.converged());
  std::vector<double> ratio;
  for (const double eps : {1e-2, 1e-3, 1e-4}) {
    const Eigen::VectorXd start = solution.v + Eigen::VectorXd::Constant(solution.v.size(), eps);
    LieNewtonOptions once;
    once.max_iterations = 1;
    once.tolerance = 0;
    const auto one = lie_newton(step, start, once);
    once.iteration = LieIteration::version2;
    const auto two = lie_newton(step, start, once);
    ratio.push_back((one.v - two.v).norm() / (eps * eps));
    EXPECT_GT(ratio.back(), 1e-3) << "the versions are different methods";
  }
  EXPECT_NEAR(ratio[2] / ratio[1], 1, 0.1);
}

TEST(LieNewton, Corollary33OnAbelianGroupsTheVersionsCoincide) {
  LieNewtonOptions chart;
  chart.iteration = LieIteration::version2;
  const auto one = record(OnThePlane{}, {0, 0});
  const auto two = record(OnThePlane{}, {0, 0}, chart);
  ASSERT_TRUE(one.converged() && two.converged());
  ASSERT_EQ(one.iterations, two.iterations);
  for (std::size_t k = 0; k < one.residuals.size(); ++k) EXPECT_NEAR(one.residuals[k], two.residuals[k], 1e-15);
}

TEST(LieNewton, TheChangeOfVariableIsVersionOne) {
  const Step step = example(NewtonExample::second, 6, 1, 0.02);
  LieNewtonOptions options;
  const auto one = record(step, zero(step), options);
  options.iteration = LieIteration::version1_by_chart;
  const auto two = record(step, zero(step), options);
  ASSERT_TRUE(one.converged() && two.converged());
  ASSERT_EQ(one.iterations, two.iterations);
  for (std::size_t k = 0; k < one.residuals.size(); ++k) EXPECT_NEAR(one.residuals[k], two.residuals[k], 1e-13);
}

/// The torus: an Abelian group on which tau is not the identity of coordinates.
struct OnTheTorus {
  using G = Product<SO2, SO2>;
  using Fibre = GroupoidFibre<G>;
  Fibre fibre_{ArrowOf<G>{SO2::exp(Vector<double, 1>(0.3)), SO2::exp(Vector<double, 1>(-0.2))}};
  const Fibre& fibre() const { return fibre_; }
  static Vector<double, 2> angles(const ArrowOf<G>& y) {
    return {SO2::log(std::get<0>(y))(0), SO2::log(std::get<1>(y))(0)};
  }
  Vector<double, 2> residual(const ArrowOf<G>& y, const Vector<double, 2>&) const {
    const Vector<double, 2> a = angles(y);
    return {std::sin(a(0)) + a(1), a(1) - 0.5 * std::exp(a(0))};
  }
  Matrix<double, 2, 2> differential(const ArrowOf<G>& y, const Vector<double, 2>&) const {
    const Vector<double, 2> a = angles(y);
    return Matrix<double, 2, 2>{{std::cos(a(0)), 1}, {-0.5 * std::exp(a(0)), 1}};
  }
  Matrix<double, 2, 2> chart_differential(const ArrowOf<G>& y, const Vector<double, 2>& v) const {
    return differential(y, v) * fibre_.dtau(v);
  }
  double norm(const Vector<double, 2>& f) const { return f.norm(); }
};

TEST(LieNewton, Corollary33OnTheTorusToo) {
  LieNewtonOptions chart;
  chart.iteration = LieIteration::version2;
  const auto one = record(OnTheTorus{}, {0, 0});
  const auto two = record(OnTheTorus{}, {0, 0}, chart);
  ASSERT_TRUE(one.converged() && two.converged());
  ASSERT_EQ(one.iterations, two.iterations);
  for (std::size_t k = 0; k < one.residuals.size(); ++k) EXPECT_NEAR(one.residuals[k], two.residuals[k], 1e-14);
}

/// f = A log y on positive numbers under multiplication, a homomorphism: f(y z) = f(y) + f(z).
struct Homomorphism {
  using G = Product<Linear<1>, Linear<1>>;
  using Fibre = GroupoidFibre<G>;
  Fibre fibre_{ArrowOf<G>{Matrix<double, 1, 1>(2.0), Matrix<double, 1, 1>(0.1)}};
  Matrix<double, 2, 2> a{{1, 2}, {-0.5, 1}};
  const Fibre& fibre() const { return fibre_; }
  Vector<double, 2> residual(const ArrowOf<G>& y, const Vector<double, 2>&) const {
    return a * Vector<double, 2>(std::log(std::get<0>(y)(0)), std::log(std::get<1>(y)(0)));
  }
  Matrix<double, 2, 2> differential(const ArrowOf<G>&, const Vector<double, 2>&) const { return a; }
  Matrix<double, 2, 2> chart_differential(const ArrowOf<G>&, const Vector<double, 2>& v) const {
    return a * fibre_.dtau(v);
  }
  double norm(const Vector<double, 2>& f) const { return f.norm(); }
};

TEST(LieNewton, Remark31AHomomorphismTakesOneIteration) {
  for (const Vector<double, 2>& start : {Vector<double, 2>(0, 0), Vector<double, 2>(5, -3)}) {
    const auto result = lie_newton(Homomorphism{}, start);
    ASSERT_TRUE(result.converged());
    EXPECT_EQ(result.iterations, 1);
  }
}

}  // namespace
}  // namespace lagroid::lie_newton_tests::versions_tests
