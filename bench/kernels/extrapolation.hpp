#pragma once
/// Starting guesses from the last steps.

#include <array>

namespace kernels {

/// Predicts the next term of a sequence x_1, x_2, ... by the polynomial of the given degree through the last terms:
/// x_{k+1} = sum_j D^j x_k, with D^j x_k = D^{j-1} x_k - D^{j-1} x_{k-1} the backward differences. Degree 0 repeats the
/// last term. Until enough terms are known the missing ones count as `first`.
template <class Term, int Degree> class Extrapolation {
 public:
  explicit Extrapolation(const Term& first = {}) { difference_[0] = first; }

  Term next() const {
    Term sum = difference_[0];
    for (int j = 1; j <= Degree; ++j) sum = sum + difference_[j];
    return sum;
  }

  void record(const Term& term) {
    Term difference = term;
    for (int j = 0; j < Degree; ++j) {
      const Term higher = difference - difference_[j];
      difference_[j] = difference;
      difference = higher;
    }
    difference_[Degree] = difference;
  }

 private:
  std::array<Term, Degree + 1> difference_{};
};

}  // namespace kernels
