// Damping, step control and failures; the same iteration on fixed groups and on source fibres.
#include "examples.hpp"

#include <lagroid/groupoids/groups/rotation_fibre.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/solvers/newton/ceres_lie.hpp>
#include <lagroid/solvers/newton/crouch_grossman.hpp>
#include <lagroid/solvers/newton/lie_differentials.hpp>
#include <lagroid/systems/newton_examples.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lagroid::lie_newton_tests {
namespace {

TEST(LieNewton, DampingLowersTheResidualOrRefuses) {
  int helped = 0;
  int refused = 0;
  for (const auto iteration : {LieIteration::version1, LieIteration::version2})
    for (Eigen::Index n = 3; n <= 6; ++n)
      for (int log2h = 0; log2h <= 6; ++log2h) {
        const Step step = example(NewtonExample::first, n, 1, std::ldexp(1.0, log2h));
        LieNewtonOptions options;
        options.iteration = iteration;
        options.tolerance = 1e-13 * (1 + step.step());
        const bool plain = lie_newton(step, zero(step), options).converged();
        options.halvings = 10;
        const auto damped = record(step, zero(step), options);
        for (std::size_t k = 0; k + 1 < damped.residuals.size(); ++k)
          EXPECT_LT(damped.residuals[k + 1], damped.residuals[k]);
        EXPECT_TRUE(damped.converged() || damped.iterations < 100) << "it goes on for nothing";
        helped += !plain && damped.converged() && iteration == LieIteration::version2;
        refused += damped.status == SolveStatus::stagnated;
      }
  EXPECT_GT(helped, 0);
  EXPECT_GT(refused, 0);
}

TEST(LieNewton, StepControlShortensUpdates) {
  const Step step = example(NewtonExample::first, 4, 1, 0.8);
  LieNewtonOptions options;
  options.iteration = LieIteration::version2;
  options.longest_update = 0.05;
  for (int limit = 1; limit <= 3; ++limit) {
    options.max_iterations = limit;
    EXPECT_LE(step.norm(lie_newton(step, zero(step), options).v), 0.05 * limit * (1 + 1e-12));
  }
  options.max_iterations = 100;
  EXPECT_TRUE(lie_newton(step, zero(step), options).converged());
}

TEST(LieNewton, WhatIsNotANumberNeverConverges) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const bool everywhere : {true, false}) {
    const RotationFibre fibre(random_orthogonal(4, 1));
    const auto g = [&](const auto& y) {
      using S = typename std::decay_t<decltype(y)>::Scalar;
      Eigen::VectorX<S> out = Eigen::VectorX<S>::Zero(6);
      out(0) = y(0, 0) * 0.1;
      if (everywhere || value_of(y(0, 1)) != fibre.centre()(0, 1)) out(1) = S(nan);
      return out;
    };
    const ImplicitStep step{fibre, AutomaticField(fibre, g), 0.1};
    for (const auto iteration :
         {LieIteration::version1, LieIteration::version1_by_chart, LieIteration::version2, LieIteration::fixed_point})
      for (const int halvings : {0, 5}) {
        LieNewtonOptions options;
        options.iteration = iteration;
        options.halvings = halvings;
        EXPECT_FALSE(lie_newton(step, Eigen::VectorXd::Zero(6), options).converged());
      }
    EXPECT_FALSE(solve_by_ceres(step, Eigen::VectorXd::Zero(6)).converged());
    EXPECT_FALSE(solve_implicit_step(step).converged());
    LieIntegrator integrator(CrouchGrossman::dirk2(), fibre, step.field());
    EXPECT_FALSE(integrator.advance(0.1).converged());
    EXPECT_EQ(integrator.y(), fibre.centre());
  }
  const Step step = example(NewtonExample::first, 4, 1, nan);
  EXPECT_EQ(lie_newton(step, zero(step)).status, SolveStatus::not_finite);
  EXPECT_EQ(solve_implicit_step(step).status, SolveStatus::not_finite);
  const Step finite = example(NewtonExample::first, 4, 1, 0.1);
  EXPECT_EQ(lie_newton(finite, Eigen::VectorXd::Constant(6, nan)).status, SolveStatus::not_finite);
  LieNewtonOptions unreachable;
  unreachable.tolerance = nan;
  EXPECT_FALSE(lie_newton(finite, zero(finite), unreachable).converged());
}

/// The first example on SO(3), by the fixed-size group.
struct FixedField {
  Vector<double, 3> g(const Matrix<double, 3, 3>& y) const { return SO3::vee(skewed(y)); }
  Matrix<double, 3, 3> dg(const Matrix<double, 3, 3>& y) const {
    Matrix<double, 3, 3> out;
    for (int i = 0; i < 3; ++i)
      out.col(i) = SO3::vee(skewed(y * SO3::hat(Vector<double, 3>(Vector<double, 3>::Unit(i)))));
    return out;
  }
  static Matrix<double, 3, 3> skewed(const Matrix<double, 3, 3>& y) {
    Matrix<double, 3, 3> u = Matrix<double, 3, 3>::Zero();
    u(0, 1) = y(0, 1);
    u(1, 2) = y(1, 2);
    return u - u.transpose();
  }
};

TEST(LieNewton, OnAFixedGroupItIsTheSameIteration) {
  for (const auto iteration : {LieIteration::version1, LieIteration::version2, LieIteration::fixed_point}) {
    const Eigen::MatrixXd z = random_orthogonal(3, 5);
    const Matrix<double, 3, 3> rotation = z * z.determinant();
    const Step at_run_time{RotationFibre<>(rotation), ExampleField<>(NewtonExample::first), 0.3};
    const ImplicitStep<GroupoidFibre<SO3>, FixedField> fixed{GroupoidFibre<SO3>(rotation), {}, 0.3};
    LieNewtonOptions options;
    options.iteration = iteration;
    const auto one = record(at_run_time, zero(at_run_time), options);
    const auto two = record(fixed, Vector<double, 3>::Zero(), options);
    ASSERT_TRUE(one.converged() && two.converged());
    EXPECT_EQ(one.iterations, two.iterations);
    EXPECT_LT((one.y - two.y).norm(), 1e-12);
    for (std::size_t k = 0; k + 1 < one.residuals.size(); ++k) EXPECT_NEAR(one.residuals[k], two.residuals[k], 1e-13);
  }
}

/// On a groupoid with objects: where does the arrow from (0.2, 0.1) end if its target determines its turn?
struct OnAGroupoid {
  using G = Product<Pair<2>, SO3>;
  using Fibre = GroupoidFibre<G>;
  Fibre fibre_;
  const Fibre& fibre() const { return fibre_; }
  template <class S> Vector<S, 5> f(const G::Arrow<S>& y) const {
    const auto& [move, turn] = y;
    const Vector<S, 2> d = move.target - move.source;
    Vector<S, 5> out;
    out << SO3::log(turn) - Vector<S, 3>(move.target(0) * 0.5, d(1), S(0.2)),
        d - Vector<S, 2>(cos(move.target(1)) * 0.3, turn(0, 1));
    return out;
  }
  Vector<double, 5> residual(const ArrowOf<G>& y, const Vector<double, 5>&) const { return f<double>(y); }
  Matrix<double, 5, 5> differential(const ArrowOf<G>& y, const Vector<double, 5>&) const {
    const G groupoid;
    const auto yd = groupoid.cast<Dual<double>>(y);
    Matrix<double, 5, 5> out;
    for (int i = 0; i < 5; ++i)
      out.col(i) = derivative_of(f<Dual<double>>(groupoid.multiply(
          yd, groupoid.tau(groupoid.target(yd), infinitesimal(Vector<double, 5>(Vector<double, 5>::Unit(i)))))));
    return out;
  }
  Matrix<double, 5, 5> chart_differential(const ArrowOf<G>& y, const Vector<double, 5>& v) const {
    return differential(y, v) * fibre_.dtau(v);
  }
  double norm(const Vector<double, 5>& x) const { return x.norm(); }
};

TEST(LieNewton, OnASourceFibreOfAGroupoidWithObjects) {
  const OnAGroupoid::G groupoid;
  ObjectOf<OnAGroupoid::G> start;
  std::get<0>(start) << 0.2, 0.1;
  const OnAGroupoid equation{OnAGroupoid::Fibre(groupoid.unit(start))};
  LieNewtonOptions chart;
  chart.iteration = LieIteration::version2;
  const auto one = record(equation, Vector<double, 5>::Zero());
  const auto two = lie_newton(equation, Vector<double, 5>::Zero(), chart);
  ASSERT_TRUE(one.converged() && two.converged());
  EXPECT_LT((groupoid.coordinates_of_arrow(one.y) - groupoid.coordinates_of_arrow(two.y)).norm(), 1e-12);
  ASSERT_GE(one.iterations, 3);
  EXPECT_NEAR(observed_order(one.residuals), 2, 0.4);
}

}  // namespace
}  // namespace lagroid::lie_newton_tests
