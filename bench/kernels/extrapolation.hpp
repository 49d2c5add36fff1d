#pragma once
/// Starting guesses from the last steps.

#include <Eigen/Core>

namespace kernels {

/// Predicts the next term of a sequence x_1, x_2, ... in R^N by the polynomial of the given degree through the last
/// terms: x_{k+1} = sum_j D^j x_k, with D^j x_k = D^{j-1} x_k - D^{j-1} x_{k-1} the backward differences. Degree 0
/// repeats the last term. Before enough terms are known the missing differences are zero.
template <int N, int Degree> class Extrapolation {
 public:
  using Term = Eigen::Matrix<double, N, 1>;

  explicit Extrapolation(const Term& first) { difference_.col(0) = first; }

  Term next() const { return difference_.rowwise().sum(); }

  void record(const Term& term) {
    Term difference = term;
    for (int j = 0; j < Degree; ++j) {
      const Term higher = difference - difference_.col(j);
      difference_.col(j) = difference;
      difference = higher;
    }
    difference_.col(Degree) = difference;
  }

 private:
  Eigen::Matrix<double, N, Degree + 1> difference_ = Eigen::Matrix<double, N, Degree + 1>::Zero();
};

}  // namespace kernels
