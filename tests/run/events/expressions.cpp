// Derivatives of expressions: what differences of their values tend to, for every operation that there is.
#include <lagroid/run/expressions/expression.hpp>
#include <lagroid/run/expressions/varied_expression.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace lagroid;

namespace events_expressions_tests {
namespace {

const std::vector<std::string> names{"t", "x", "velocity.x"};

TEST(DerivativesOfExpressions, AreWhatDifferencesTendTo) {
  for (const char* text : {"x - 0.5",
                           "velocity.x + 2",
                           "-x^2",
                           "2^-x",
                           "t^x^velocity.x",
                           "x^0 + x^1 + x^2",
                           "1 - -x*velocity.x/t",
                           "x > 1 && t < 3",
                           "x > t ? x*t : velocity.x^2",
                           "x <= t || x != 2 ? x : t",
                           "log(x)*t + ln(velocity.x) + log2(x) + 1e3*log10(x)",
                           "avg(x, 1, t) + sum(x, t, 2*t)",
                           "max(x, t) + min(x, 1.5e-1) + min(velocity.x, x, t)",
                           "sqrt(x^2 + velocity.x^2) - 1",
                           "atan2(x, t)/velocity.x",
                           "cos(2*pi*x) + sin(_pi*t)*_e",
                           "tan(x) + atan(velocity.x)",
                           "abs(-x) + abs(t)",
                           "sign(x)*tanh(t) + asin(x) - acos(t) + acosh(velocity.x)",
                           "sinh(x) + cosh(t) + asinh(velocity.x) + atanh(x)",
                           "sin(x)*exp(-t)",
                           "rint(x) + x",
                           "(x+t)*3/velocity.x-.5"}) {
    std::vector<double> values{0.3, 0.7, 1.9};
    const auto expression = parse_expression(text, names, values.data());
    const std::vector<std::size_t> used = expression->used();
    std::vector<double> by(used.size());
    for (const double x : {0.7, 0.8, 0.55}) {
      values[1] = x;
      EXPECT_EQ(expression->differentiate(by.data()), expression->value()) << text;
      for (std::size_t k = 0; k < used.size(); ++k) {
        double& value = values[used[k]];
        const double here = value;
        const auto at = [&](double shift) {
          value = here + shift;
          const double f = expression->value();
          value = here;
          return f;
        };
        const auto difference = [&](double h) { return (at(h) - at(-h)) / (2 * h); };
        const double better = (4 * difference(1e-3) - difference(2e-3)) / 3;
        EXPECT_NEAR(by[k], better, 1e-9 * std::max(1.0, std::abs(better)) + 1e-10) << text << " by " << names[used[k]];
      }
    }
  }
}

TEST(DerivativesOfExpressions, AreNoNumbersWhereThereAreNone) {
  std::vector<double> values{0, 0, 1};
  double by[3];
  for (const char* text : {"abs(x)", "sqrt(x)", "acosh(velocity.x)"}) {
    const auto expression = parse_expression(text, names, values.data());
    EXPECT_TRUE(std::isfinite(expression->differentiate(by))) << text;
    EXPECT_FALSE(std::isfinite(by[0])) << text;
  }
  // A number as a condition: it is not judged by its place.
  const auto judged = parse_expression("x ? t : 2", names, values.data());
  EXPECT_EQ(judged->differentiate(by), 2);
  EXPECT_TRUE(std::isnan(by[0]));
}

TEST(DerivativesOfExpressions, GoOnFromThoseOfTheirNumbers) {
  VariedExpression area("x*velocity.x + t", names);
  VariedVector numbers(3);
  numbers << VariedNumber(0.5), VariedNumber::variable(3.0, 0), VariedNumber::variable(4.0, 1);
  numbers(2) = numbers(2) + numbers(1) * 2.0;  // 10, of both
  const VariedNumber found = area(numbers);
  EXPECT_EQ(found.value, 30.5);
  EXPECT_EQ(found.tangent(0), 10 + 3 * 2);
  EXPECT_EQ(found.tangent(1), 3);
}

}  // namespace
}  // namespace events_expressions_tests
