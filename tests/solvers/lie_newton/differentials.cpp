// Differentials: closed forms, truncated series, finite differences, automatic.
#include "examples.hpp"

#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/solvers/newton/lie_differentials.hpp>
#include <lagroid/systems/newton_examples.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace lagroid::lie_newton_tests::differentials_tests {
namespace {

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
    using std::sin;
    using S = typename std::decay_t<decltype(r)>::Scalar;
    return Vector<S, 3>(r(0, 1) * r(2, 2), sin(r(1, 0)), r(2, 1));
  };
  const ImplicitStep automatic{fixed, AutomaticField(fixed, spin), 0.3};
  const auto result = lie_newton(automatic, Vector<double, 3>::Zero());
  ASSERT_TRUE(result.converged());
  const FiniteDifferences quotients(automatic);
  EXPECT_LT((quotients.differential(result.y, result.v) - automatic.differential(result.y, result.v)).norm(), 1e-6);
}

TEST(LieNewton, ASingularDifferentialIsTyped) {
  struct Flat : OnThePlane {
    Matrix<double, 2, 2> differential(const Vector<double, 2>&, const Vector<double, 2>&) const {
      return Matrix<double, 2, 2>::Zero();
    }
  };
  EXPECT_EQ(lie_newton(Flat{}, {0, 0}).status, SolveStatus::singular);
}

}  // namespace
}  // namespace lagroid::lie_newton_tests::differentials_tests
