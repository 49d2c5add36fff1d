// The Newton iterations on Lie groups and source fibres: iteration counts of the reference file, orders, theorems of
// [N].
#include <lagroid/groupoids/groups/linear.hpp>
#include <lagroid/groupoids/groups/rotation_fibre.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/solvers/newton/ceres_lie.hpp>
#include <lagroid/solvers/newton/crouch_grossman.hpp>
#include <lagroid/solvers/newton/lie_differentials.hpp>
#include <lagroid/systems/newton_examples.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <vector>

using namespace lagroid;

namespace {

using Step = ImplicitStep<RotationFibre<>, ExampleField<>>;

Step example(NewtonExample which, Eigen::Index n, std::uint64_t seed, double h) {
  return {RotationFibre(random_orthogonal(n, seed)), ExampleField(which), h};
}
Eigen::VectorXd zero(const Step& step) { return Eigen::VectorXd::Zero(step.fibre().dimension()); }

/// An iteration and the norms of f along it.
template <class E> struct Recorded : LieNewtonResult<typename E::Fibre> { std::vector<double> residuals; };
template <class E>
Recorded<E> record(const E& equation, const typename E::Fibre::Vector& start, const LieNewtonOptions& options = {}) {
  std::vector<double> residuals;
  auto result = lie_newton(equation, start, options, [&](double r) { residuals.push_back(r); });
  return {std::move(result), std::move(residuals)};
}

double median(std::vector<double> x) {
  std::nth_element(x.begin(), x.begin() + std::ptrdiff_t(x.size() / 2), x.end());
  return x[x.size() / 2];
}

struct ReferenceCount {
  int records = 0;
  int wrong = 0;        ///< not converged, or not after as many iterations but for one
  int wrong_small = 0;  ///< of these, with h < 1
  /// Of these, where the record's own order says that its last iterations were no round-off.
  int wrong_above_round_off = 0;
};
/// The records, all of iterations that converged, against iterations over S.
template <class S> ReferenceCount count_against_references(bool damped) {
  const auto cases = nlohmann::json::parse(std::ifstream(LAGROID_TEST_DATA "/lie-newton.json"));
  const std::map<std::string, LieIteration> methods{{"FP", LieIteration::fixed_point},
                                                    {"V1", LieIteration::version1},
                                                    {"V2", LieIteration::version2},
                                                    {"V2ls", LieIteration::version2}};
  ReferenceCount out;
  for (const auto& record : cases) {
    if ((record.at("method") == "V2ls") != damped) continue;
    const Eigen::Index n = record.at("N");
    const auto which = record.at("ex") == 1 ? NewtonExample::first : NewtonExample::second;
    const int log2h = record.at("log2h");
    const ImplicitStep step{RotationFibre(random_orthogonal<S>(n, record.at("seed"))), ExampleField<S>(which),
                            std::ldexp(1.0, log2h)};
    LieNewtonOptions options;
    options.iteration = methods.at(record.at("method"));
    options.halvings = damped ? 20 : 0;
    const auto result = lie_newton(step, Eigen::VectorX<S>::Zero(n * (n - 1) / 2), options);
    ++out.records;
    EXPECT_EQ(record.at("conv"), 1);
    if (result.converged() && std::abs(result.iterations - record.at("its").get<int>()) <= 1) continue;
    const double order = record.at("order").is_null() ? 2.0 : record.at("order").get<double>();
    ++out.wrong;
    out.wrong_small += log2h < 0;
    out.wrong_above_round_off += order > 1.5 && order < 3;
  }
  return out;
}

// For large h the tolerance lies below the round-off of h g(y) in double precision, and when an iteration meets it is
// chance. With more digits only the records keep that chance.
TEST(LieNewton, CountsIterationsAsTheReferenceFileDoes) {
  const auto extended = count_against_references<long double>(false);
  EXPECT_EQ(extended.records, 1420);
  EXPECT_EQ(extended.wrong_above_round_off, 0);
  EXPECT_LE(extended.wrong, 7);
  const auto plain = count_against_references<double>(false);
  EXPECT_EQ(plain.wrong_small, 0);
  EXPECT_LE(plain.wrong, plain.records / 50);
}

// The file does not say by which rule its line search takes or refuses an update.
TEST(LieNewton, DampedVersionTwoCountsNearlyAsTheReferenceFileDoes) {
  const auto damped = count_against_references<long double>(true);
  EXPECT_EQ(damped.records, 548);
  EXPECT_LE(damped.wrong, damped.records / 40);
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
          const auto result = record(step, zero(step), options);
          if (result.converged() && result.iterations >= 3) orders.push_back(observed_order(result.residuals));
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
  const auto one = record(OnThePlane{}, {0, 0});
  const auto two = record(OnThePlane{}, {0, 0}, chart);
  ASSERT_TRUE(one.converged() && two.converged());
  ASSERT_EQ(one.iterations, two.iterations);
  for (std::size_t k = 0; k < one.residuals.size(); ++k) EXPECT_NEAR(one.residuals[k], two.residuals[k], 1e-15);
}

TEST(LieNewton, QuadraticDecayRunByRunInExtendedPrecision) {
  for (const auto iteration : {LieIteration::version1, LieIteration::version1_by_chart, LieIteration::version2})
    for (const auto which : {NewtonExample::first, NewtonExample::second})
      for (Eigen::Index n = 3; n <= 8; ++n)
        for (std::uint64_t seed = 30; seed < 33; ++seed) {
          const double h = which == NewtonExample::first ? 0.25 : 0.01;
          const ImplicitStep<RotationFibre<long double>, ExampleField<long double>> step{
              RotationFibre(random_orthogonal<long double>(n, seed)), ExampleField<long double>(which), h};
          LieNewtonOptions options;
          options.iteration = iteration;
          options.tolerance = 1e-17;
          const auto result = record(step, Eigen::VectorX<long double>::Zero(n * (n - 1) / 2), options);
          ASSERT_TRUE(result.converged());
          // r' <= C r^2 with one C for the run, until round-off.
          const auto& r = result.residuals;
          const double c = 2 * std::max(1.0, r[1] / (r[0] * r[0]));
          for (std::size_t k = 1; k + 1 < r.size(); ++k)
            EXPECT_LE(r[k + 1], c * r[k] * r[k] + 2e-18 * double(n)) << n << ' ' << seed;
          ASSERT_GE(r.size(), 4U);
          EXPECT_LT(r[r.size() - 2], 1e-5);
        }
}

TEST(LieNewton, EveryDifferentialIsTheExactOneToItsOrder) {
  for (const auto which : {NewtonExample::first, NewtonExample::second}) {
    const Step step = example(which, 5, 4, 0.2);
    const auto solved = lie_newton(step, zero(step));
    const Eigen::MatrixXd exact = step.differential(solved.y, solved.v);
    const Eigen::MatrixXd chart = step.chart_differential(solved.y, solved.v);
    EXPECT_LT((exact * step.fibre().dtau(solved.v) - chart).norm(), 1e-13 * chart.norm());  // (3.24)
    const FiniteDifferences quotients(step);
    EXPECT_LT((quotients.differential(solved.y, solved.v) - exact).norm(), 2e-6 * exact.norm());
    EXPECT_LT((quotients.chart_differential(solved.y, solved.v) - chart).norm(), 2e-6 * chart.norm());
    const QuotientFibre log(step.fibre());
    EXPECT_LT((log.dtau_inverse(solved.v) - step.fibre().dtau_inverse(solved.v)).norm(), 2e-6);
    for (const int order : {0, 1, 2, 4}) {
      const TruncatedFibre truncated(step.fibre(), order);
      // The series of the inverse has even powers only after the first.
      const int error_order = order == 0 ? 1 : order + 2 - order % 2;
      const auto error = [&](double size, bool inverse) {
        const Eigen::VectorXd v = size * solved.v / solved.v.norm();
        return inverse ? (truncated.dtau_inverse(v) - step.fibre().dtau_inverse(v)).norm()
                       : (truncated.dtau(v) - step.fibre().dtau(v)).norm();
      };
      EXPECT_NEAR(std::log2(error(0.4, true) / error(0.2, true)), error_order, 0.2) << order;
      EXPECT_NEAR(std::log2(error(0.2, false) / error(0.1, false)), order + 1, 0.2) << order;
    }
  }
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

TEST(LieNewton, FiniteDifferencesTakeAsManyIterationsAndTruncatedSeriesMore) {
  for (const auto which : {NewtonExample::first, NewtonExample::second})
    for (Eigen::Index n = 3; n <= 6; ++n) {
      const Step step = example(which, n, 7, which == NewtonExample::first ? 0.25 : 0.02);
      const auto iterations = [&](const auto& equation, LieIteration iteration) {
        LieNewtonOptions options;
        options.iteration = iteration;
        const auto result = lie_newton(equation, zero(step), options);
        EXPECT_TRUE(result.converged());
        return result.iterations;
      };
      const int exact = iterations(step, LieIteration::version1);
      EXPECT_LE(std::abs(iterations(FiniteDifferences(step), LieIteration::version1) - exact), 1);
      EXPECT_LE(std::abs(iterations(FiniteDifferences(step), LieIteration::version2) -
                         iterations(step, LieIteration::version2)),
                1);
      const ImplicitStep quotient{QuotientFibre(step.fibre()), step.field(), step.step()};
      EXPECT_LE(std::abs(iterations(quotient, LieIteration::version1) - exact), 1);
      for (const int order : {0, 1}) {  // (3.10), (3.11); (3.16), (3.17)
        const ImplicitStep truncated{TruncatedFibre(step.fibre(), order), step.field(), step.step()};
        EXPECT_GE(iterations(truncated, LieIteration::version1), exact);
        EXPECT_GE(iterations(TruncatedTransport(step, order), LieIteration::version1_by_chart), exact);
      }
      EXPECT_GT(iterations(TruncatedTransport(step, 0), LieIteration::version1_by_chart), exact);
    }
}

TEST(LieNewton, AutomaticDifferentialsAreTheClosedForms) {
  // The first example written once, for any scalar.
  const auto g = [](const auto& y) {
    using S = typename std::decay_t<decltype(y)>::Scalar;
    const Eigen::Index n = y.rows();
    Eigen::VectorX<S> out = Eigen::VectorX<S>::Zero(n * (n - 1) / 2);
    for (Eigen::Index r = 0, i = 0; r + 1 < n; i += n - 1 - r, ++r) out(i) = y(r, r + 1);
    return out;
  };
  const Step step = example(NewtonExample::first, 6, 2, 0.3);
  const AutomaticField field(step.fibre(), g);
  const Eigen::MatrixXd y = random_orthogonal(6, 9);
  EXPECT_LT((field.g(y) - step.field().g(y)).norm(), 1e-15);
  EXPECT_LT((field.dg(y) - step.field().dg(y)).norm(), 1e-14);
  const GroupoidFibre<SO3> fixed(SO3::exp(Vector<double, 3>(0.2, 0.1, -0.4)));
  const auto spin = [](const auto& r) {
    using S = typename std::decay_t<decltype(r)>::Scalar;
    return Vector<S, 3>(r(0, 1) * r(2, 2), sin(r(1, 0)), r(2, 1));
  };
  const ImplicitStep automatic{fixed, AutomaticField(fixed, spin), 0.3};
  const auto result = lie_newton(automatic, Vector<double, 3>::Zero());
  ASSERT_TRUE(result.converged());
  const FiniteDifferences quotients(automatic);
  EXPECT_LT((quotients.differential(result.y, result.v) - automatic.differential(result.y, result.v)).norm(), 1e-6);
}

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

TEST(LieNewton, ASingularDifferentialIsTyped) {
  struct Flat : OnThePlane {
    Matrix<double, 2, 2> differential(const Vector<double, 2>&, const Vector<double, 2>&) const {
      return Matrix<double, 2, 2>::Zero();
    }
  };
  EXPECT_EQ(lie_newton(Flat{}, {0, 0}).status, SolveStatus::singular);
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
