#pragma once
/// A function of named numbers, made of its text: "x - 0.5", "sqrt(x^2 + y^2) - 1".
///
/// Scenes say by it what they look for, without a line of C++.
///
///     std::vector<double> values{0.6, 0.8};
///     const auto radius = parse_expression("sqrt(x^2 + y^2)", {"x", "y"}, values.data());
///     const double r = radius->value();
///     std::vector<double> by(radius->used().size());
///     radius->differentiate(by.data());  // 0.6, 0.8
///
/// Requires that the numbers stay where they are; names may hold blanks and dots. Sums of a name and a number are read
/// by the library itself, all else by muparser. Returns the function, which reads the numbers anew for every value. Its
/// derivatives are exact; where there are none, as of abs(x) at zero, they are no numbers.
/// Errors: std::invalid_argument for a text that is no expression of these names, with what is wrong in it, or that
/// takes muparser in a build without it.

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace lagroid {

class Expression {
 public:
  virtual ~Expression() = default;
  virtual double value() const = 0;
  /// Which of the names it depends on.
  virtual std::vector<std::size_t> used() const = 0;
  /// The value, and its derivatives by the names used, in their order.
  virtual double differentiate(double* by) = 0;
};

/// The expression of numbers called names[i], which stand at values[i].
std::unique_ptr<Expression> parse_expression(const std::string& text, const std::vector<std::string>& names,
                                             const double* values);

namespace detail {

/// Any expression; of muparser, or std::invalid_argument without it.
std::unique_ptr<Expression> parse_any_expression(const std::string& text, const std::vector<std::string>& names,
                                                 const double* values);

}  // namespace detail

}  // namespace lagroid
