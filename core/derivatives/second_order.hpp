#pragma once
/// A function of n variables, n known when it runs, with its first and second derivatives as one row of numbers:
///
///     f;  f_1 ... f_n;  f_11 ... f_1n, f_22 ... f_2n, ..., f_nn      the upper triangle, row by row
///
///     std::vector<double> numbers(SecondOrder::count(2));
///     const SecondOrder f{numbers.data(), 2};
///     const double mixed = f.second(1, 0);  // which is f.second(0, 1)
///
/// Refers to the numbers. Requires indices of variables. Nothing throws.

#include <cstddef>

namespace lagroid {

struct SecondOrder {
  const double* numbers;
  int variables;

  static constexpr std::size_t count(int variables) {
    const std::size_t n = std::size_t(variables);
    return 1 + n + n * (n + 1) / 2;
  }
  double value() const { return numbers[0]; }
  double slope(int i) const { return numbers[1 + i]; }
  double second(int i, int j) const {
    const int row = i < j ? i : j, column = i < j ? j : i;
    return numbers[1 + variables + row * variables - row * (row - 1) / 2 + column - row];
  }
  /// The one that stands `index` places after it, as the components of a constraint do.
  SecondOrder after(int index) const { return {numbers + std::size_t(index) * count(variables), variables}; }
};

}  // namespace lagroid
