// exp, log and their differentials on SO(N), N at run time.
#include <lagroid/groupoids/groups/rotations.hpp>
#include <lagroid/groupoids/groups/so3.hpp>

#include <gtest/gtest.h>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <random>

using namespace lagroid;

namespace groupoids_rotations_tests {
namespace {

constexpr double pi = 3.14159265358979323846;

class Rotations : public testing::TestWithParam<int> {
 protected:
  int n() const { return GetParam(); }
  double bound() const { return 2e-15 * n(); }
  Eigen::MatrixXd random_skew(double size) {
    Eigen::VectorXd x(n() * (n() - 1) / 2);
    for (double& c : x) c = size * normal_(generator_) / std::sqrt(n());
    return skew(x, n());
  }
  Eigen::MatrixXd random_rotation() { return SkewSpectrum<double>(random_skew(3)).exp(); }
  std::mt19937 generator_{7};
  std::normal_distribution<double> normal_;
};

TEST_P(Rotations, ExpIsOrthogonalAndSatisfiesItsEquation) {
  for (const double size : {1e-9, 1e-3, 0.5, 3.0, 30.0}) {
    const Eigen::MatrixXd x = random_skew(size);
    const SkewSpectrum<double> spectrum(x);
    const Eigen::MatrixXd q = spectrum.exp();
    EXPECT_LT((q.transpose() * q - Eigen::MatrixXd::Identity(n(), n())).norm(), 10 * bound());
    // exp(X) = exp(X/2)^2, down to where the series sums to it.
    const Eigen::MatrixXd half = SkewSpectrum<double>(Eigen::MatrixXd(0.5 * x)).exp();
    EXPECT_LT((half * half - q).norm(), 10 * bound() * (1 + size));
    const double small = std::min(1.0, 0.1 / x.norm());
    Eigen::MatrixXd term = Eigen::MatrixXd::Identity(n(), n());
    Eigen::MatrixXd sum = term;
    for (int k = 1; k < 12; ++k) {
      term = (term * x * (small / k)).eval();
      sum += term;
    }
    EXPECT_LT((SkewSpectrum<double>(Eigen::MatrixXd(small * x)).exp() - sum).norm(), 10 * bound()) << size;
  }
}

TEST_P(Rotations, LogInvertsExpToAllDigits) {
  for (const double size : {1e-12, 1e-6, 1e-3, 0.3, 1.0}) {
    Eigen::MatrixXd x = random_skew(size);
    if (SkewSpectrum<double>(x).radius() > 3) x *= 3 / SkewSpectrum<double>(x).radius();
    const auto log = principal_log(SkewSpectrum<double>(x).exp());
    ASSERT_TRUE(log.has_value());
    EXPECT_LT((*log - x).norm(), 20 * bound() * x.norm()) << size;
  }
}

TEST_P(Rotations, LogOfEigenvaluesAtAndNearMinusOne) {
  if (n() < 4) GTEST_SKIP() << "two planes are needed";
  for (const double off : {0.0, 1e-16, 1e-12, 1e-8, 1e-4}) {
    const Eigen::MatrixXd u = random_rotation();
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(n(), n());
    for (const int i : {0, 2}) {
      x(i + 1, i) = pi - off * (1 + i);
      x(i, i + 1) = -x(i + 1, i);
    }
    const Eigen::MatrixXd q = SkewSpectrum<double>(Eigen::MatrixXd(u * x * u.transpose())).exp();
    const auto log = principal_log(q);
    ASSERT_TRUE(log.has_value()) << off;
    EXPECT_LT((SkewSpectrum<double>(*log).exp() - q).norm(), 20 * bound()) << off;
    EXPECT_NEAR(SkewSpectrum<double>(*log).radius(), pi - off, 1e-13);
  }
}

TEST_P(Rotations, ReflectionsHaveNoLog) {
  Eigen::MatrixXd q = random_rotation();
  q.col(0) *= -1;
  EXPECT_FALSE(principal_log(q).has_value());
}

TEST_P(Rotations, DexpIsTheDifferentialOfExp) {
  for (const double size : {1e-9, 0.5, 3.0}) {
    const Eigen::MatrixXd x = random_skew(size);
    const Eigen::MatrixXd y = random_skew(1);
    const SkewSpectrum<double> spectrum(x);
    const double t = 1e-5;
    const auto at = [&](double s) { return SkewSpectrum<double>(Eigen::MatrixXd(x + s * y)).exp(); };
    const Eigen::MatrixXd quotient = spectrum.exp().transpose() * (at(t) - at(-t)) / (2 * t);
    EXPECT_LT((quotient - spectrum.dexp(y)).norm(), 1e-8 * (1 + y.norm()));
    EXPECT_LT((spectrum.dexp(spectrum.dexp_inverse(y)) - y).norm(), 1e-12 * y.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Rotations, testing::Values(2, 3, 4, 5, 8, 15, 50));

TEST(Rotations3, AreRodrigues) {
  const Vector<double, 3> w(0.3, -1.1, 0.7);
  const Eigen::MatrixXd x = SO3::hat(w);
  const SkewSpectrum<double> spectrum(x);
  EXPECT_LT((spectrum.exp() - SO3::exp(w)).norm(), 1e-14);
  const Vector<double, 3> u(-0.2, 0.5, 0.1);
  const Vector<double, 3> differential = SO3::dexp(w) * u;
  EXPECT_LT((spectrum.dexp(SO3::hat(u)) - SO3::hat(differential)).norm(), 1e-14);
}

}  // namespace
}  // namespace groupoids_rotations_tests
