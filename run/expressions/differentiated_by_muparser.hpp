#pragma once
/// The derivatives of an expression, by muparser: each of its values is the place of a number that is kept with its
/// derivatives, and each of its operations works on those.
///
///     detail::DifferentiatedByMuParser radius("sqrt(x^2 + y^2)", {"x", "y"}, {0, 1}, values.data());
///     double by[2];
///     const double r = radius.differentiate(by);
///
/// Requires a text that muparser reads, of the names whose places are `used`, and values that stay where they are.
/// Nothing throws but where memory is short.

#include <muParser.h>

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace lagroid::detail {

class DifferentiatedByMuParser {
 public:
  DifferentiatedByMuParser(const std::string& text, const std::vector<std::string>& names,
                           const std::vector<std::size_t>& used, const double* values);
  DifferentiatedByMuParser(const DifferentiatedByMuParser&) = delete;  // the parser knows handles by their places
  DifferentiatedByMuParser& operator=(const DifferentiatedByMuParser&) = delete;

  /// The value, and its derivatives by the names used, in their order.
  double differentiate(double* by);
  /// The size of the largest number on the way to the last value: what its rounding is of.
  double largest() const { return largest_; }

  struct Number {
    double value;
    Eigen::VectorXd by;
  };

 private:
  double evaluate();

  mu::Parser parser_;
  std::vector<std::size_t> used_;
  const double* values_;
  std::vector<double> handles_;  ///< of the names used
  std::vector<Number> numbers_;  ///< first zero and one, then the names used, then constants of the text
  double largest_ = 0;
  std::size_t kept_ = 0;  ///< those of the numbers that every evaluation begins with
};

}  // namespace lagroid::detail
