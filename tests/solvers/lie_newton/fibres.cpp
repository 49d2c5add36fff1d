// The same iteration on fixed groups and on source fibres of groupoids with objects.
#include "examples.hpp"

#include <lagroid/groupoids/groups/rotation_fibre.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace lagroid::lie_newton_tests::fibres_tests {
namespace {

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
    using std::cos;
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
}  // namespace lagroid::lie_newton_tests::fibres_tests
