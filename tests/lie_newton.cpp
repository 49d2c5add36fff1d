// The Newton iterations on Lie groups and alpha-fibres: iteration counts of the reference file, orders, theorems of
// [N].
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/groupoids/rotation_fibre.hpp>
#include <lagroid/groupoids/so3.hpp>
#include <lagroid/groupoids/vector_group.hpp>
#include <lagroid/solvers/lie_newton.hpp>
#include <lagroid/systems/newton_examples.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

using namespace lagroid;

namespace {

using Step = ImplicitStep<RotationFibre, ExampleField>;

Step example(NewtonExample which, Eigen::Index n, std::uint64_t seed, double h) {
  return {RotationFibre(random_orthogonal(n, seed)), ExampleField(which), h};
}
Eigen::VectorXd zero(const Step& step) { return Eigen::VectorXd::Zero(step.fibre().dimension()); }

/// The observed order from three residuals, as [N] section 5 defines it.
double observed_order(const std::vector<double>& r) {
  const std::size_t p = r.size() - 1;
  return std::log(r[p - 1] / r[p - 2]) / std::log(r[p - 2] / r[p - 3]);
}

double median(std::vector<double> x) {
  std::nth_element(x.begin(), x.begin() + std::ptrdiff_t(x.size() / 2), x.end());
  return x[x.size() / 2];
}

// Records with h <= 4: beyond, the tolerance is near the round-off of h g, and when it is met is chance.
TEST(LieNewton, CountsIterationsAsTheReferenceFileDoes) {
  const auto cases = nlohmann::json::parse(std::ifstream(LAGROID_TEST_DATA "/lie-newton.json"));
  const std::map<std::string, LieIteration> methods{
      {"FP", LieIteration::fixed_point}, {"V1", LieIteration::version1}, {"V2", LieIteration::version2}};
  for (const auto& record : cases) {
    const double h = std::ldexp(1.0, record.at("log2h").get<int>());
    const auto which = record.at("ex") == 1 ? NewtonExample::first : NewtonExample::second;
    const Step step = example(which, record.at("N"), record.at("seed"), h);
    LieNewtonOptions options;
    options.iteration = methods.at(record.at("method"));
    const auto result = lie_newton(step, zero(step), options);
    EXPECT_EQ(result.converged(), record.at("conv") == 1) << record << to_string(result.status);
    if (!result.converged()) continue;
    EXPECT_LE(std::abs(result.iterations() - record.at("its").get<int>()), 1) << record;
  }
}

TEST(LieNewton, OrdersAreTwoAndTheFixedPointsOne) {
  const std::map<LieIteration, double> expected{
      {LieIteration::version1, 2}, {LieIteration::version2, 2}, {LieIteration::fixed_point, 1}};
  for (const auto& [iteration, order] : expected) {
    std::vector<double> orders;
    for (const auto which : {NewtonExample::first, NewtonExample::second})
      for (Eigen::Index n = 3; n <= 8; ++n)
        for (std::uint64_t seed = 10; seed < 16; ++seed) {
          const Step step = example(which, n, seed, which == NewtonExample::first ? 0.25 : 0.01);
          LieNewtonOptions options;
          options.iteration = iteration;
          const auto result = lie_newton(step, zero(step), options);
          if (result.converged() && result.iterations() >= 3) orders.push_back(observed_order(result.residuals));
        }
    ASSERT_GT(orders.size(), 20U);
    EXPECT_NEAR(median(orders), order, 0.1);
  }
}

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

/// A curve and a line in the plane.
struct OnThePlane {
  using Fibre = GroupoidFibre<VectorGroup<2>>;
  Fibre fibre_{Vector<double, 2>(0.3, -0.2)};
  const Fibre& fibre() const { return fibre_; }
  Vector<double, 2> residual(const Vector<double, 2>& y, const Vector<double, 2>&) const {
    return {std::sin(y(0)) + y(1), y(1) - 0.5 * std::exp(y(0))};
  }
  Matrix<double, 2, 2> differential(const Vector<double, 2>& y, const Vector<double, 2>&) const {
    Matrix<double, 2, 2> m;
    m << std::cos(y(0)), 1, -0.5 * std::exp(y(0)), 1;
    return m;
  }
  Matrix<double, 2, 2> chart_differential(const Vector<double, 2>& y, const Vector<double, 2>& v) const {
    return differential(y, v) * fibre_.dtau(v);
  }
  double norm(const Vector<double, 2>& f) const { return f.norm(); }
};
TEST(LieNewton, Corollary33OnAbelianGroupsTheVersionsCoincide) {
  LieNewtonOptions chart;
  chart.iteration = LieIteration::version2;
  const auto one = lie_newton(OnThePlane{}, {0, 0});
  const auto two = lie_newton(OnThePlane{}, {0, 0}, chart);
  ASSERT_TRUE(one.converged() && two.converged());
  ASSERT_EQ(one.iterations(), two.iterations());
  for (std::size_t k = 0; k < one.residuals.size(); ++k) EXPECT_NEAR(one.residuals[k], two.residuals[k], 1e-15);
}

/// A linear map of the plane.
struct Homomorphism : OnThePlane {
  Vector<double, 2> residual(const Vector<double, 2>& y, const Vector<double, 2>&) const {
    return {y(0) + 2 * y(1), y(1)};
  }
  Matrix<double, 2, 2> differential(const Vector<double, 2>&, const Vector<double, 2>&) const {
    Matrix<double, 2, 2> m;
    m << 1, 2, 0, 1;
    return m;
  }
};
TEST(LieNewton, Remark31AHomomorphismTakesOneIteration) {
  const auto result = lie_newton(Homomorphism{}, {5, -3});
  ASSERT_TRUE(result.converged());
  EXPECT_EQ(result.iterations(), 1);
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
struct SO3Fibre : GroupoidFibre<SO3> {
  using GroupoidFibre::GroupoidFibre;
  double norm(const Vector& v) const { return v.norm(); }  // the spectral norm of hat(v)
};
TEST(LieNewton, OnAFixedGroupItIsTheSameIteration) {
  for (const auto iteration : {LieIteration::version1, LieIteration::version2, LieIteration::fixed_point}) {
    const Eigen::MatrixXd z = random_orthogonal(3, 5);
    const Matrix<double, 3, 3> rotation = z * z.determinant();
    const Step at_run_time{RotationFibre(rotation), ExampleField(NewtonExample::first), 0.3};
    const ImplicitStep<SO3Fibre, FixedField> fixed{SO3Fibre(rotation), {}, 0.3};
    LieNewtonOptions options;
    options.iteration = iteration;
    const auto one = lie_newton(at_run_time, zero(at_run_time), options);
    const auto two = lie_newton(fixed, Vector<double, 3>::Zero(), options);
    ASSERT_TRUE(one.converged() && two.converged());
    EXPECT_EQ(one.iterations(), two.iterations());
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
TEST(LieNewton, OnAnAlphaFibreOfAGroupoidWithObjects) {
  const OnAGroupoid::G groupoid;
  ObjectOf<OnAGroupoid::G> start;
  std::get<0>(start) << 0.2, 0.1;
  const OnAGroupoid equation{OnAGroupoid::Fibre(groupoid.unit(start))};
  LieNewtonOptions chart;
  chart.iteration = LieIteration::version2;
  const auto one = lie_newton(equation, Vector<double, 5>::Zero());
  const auto two = lie_newton(equation, Vector<double, 5>::Zero(), chart);
  ASSERT_TRUE(one.converged() && two.converged());
  EXPECT_LT((groupoid.coordinates_of_arrow(one.y) - groupoid.coordinates_of_arrow(two.y)).norm(), 1e-12);
  ASSERT_GE(one.iterations(), 3);
  EXPECT_NEAR(observed_order(one.residuals), 2, 0.4);
}

}  // namespace
