#pragma once
/// A function of named numbers with derivatives, made of its text: f(x), df = f_x dx.
///
///     VariedExpression radius("sqrt(x^2 + y^2) - 1", {"x", "y"});
///     const VariedNumber r = radius(numbers);  // as many as there are names
///
/// Requires numbers in the order of the names. Returns the value with its derivatives, which are no numbers where the
/// function has none. Errors: those of parse_expression.

#include <lagroid/run/expressions/expression.hpp>
#include <lagroid/solvers/sensitivity/varied_point.hpp>

#include <memory>
#include <string>
#include <vector>

namespace lagroid {

class VariedExpression {
 public:
  VariedExpression(const std::string& text, const std::vector<std::string>& names);

  VariedNumber operator()(const VariedVector& numbers);

 private:
  std::vector<double> values_;
  std::unique_ptr<Expression> expression_;
  std::vector<std::size_t> used_;
  std::vector<double> by_;
};

}  // namespace lagroid
