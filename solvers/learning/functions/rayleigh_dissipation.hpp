#pragma once
/// Rayleigh's dissipation with parameters: a force -R v against velocities v_1, ..., v_k of any number of components,
///
///     f_i = -sum_j R_ij v_j,    R = L L^T,
///
/// L lower triangular, so that R is symmetric and positive semidefinite whatever the parameters are, zero included.
///
///     learning::RayleighDissipation<2> friction(2, learning::Dissipation::rayleigh);
///     const double theta[] = {0.5, 0, 0.1};  // the rows of L
///     friction.set(theta);
///     const Eigen::Matrix2d r = friction.matrix();
///
/// Requires `set` with size() parameters before anything is evaluated. Nothing throws.

#include <lagroid/core/types.hpp>
#include <lagroid/solvers/learning/model.hpp>

#include <algorithm>
#include <random>

namespace lagroid::learning {

/// R = L L^T of k velocities, where a model declares dissipation; else of no parameters, and no force. K is k, or
/// Eigen::Dynamic.
template <int K, class S = double> class RayleighDissipation {
 public:
  using Square = Eigen::Matrix<S, K, K>;

  RayleighDissipation(int velocities, Dissipation dissipation)
      : dissipation_(dissipation), matrix_(Square::Zero(velocities, velocities)), factor_(matrix_) {}

  bool declared() const { return dissipation_ != Dissipation::none; }
  int size() const { return declared() ? int(matrix_.rows() * (matrix_.rows() + 1) / 2) : 0; }
  const Square& matrix() const { return matrix_; }

  void set(const S* theta) {
    if (!declared()) return;
    const int k = int(matrix_.rows());
    for (int i = 0; i < k; ++i)
      for (int j = 0; j <= i; ++j) factor_(i, j) = *theta++;
    for (int i = 0; i < k; ++i)
      for (int j = 0; j < k; ++j) {
        S sum(0.0);
        for (int n = 0; n <= std::min(i, j); ++n) sum += factor_(i, n) * factor_(j, n);
        matrix_(i, j) = sum;
      }
  }
  /// f_i += sum_j R_ij v_j; v and f are k vectors of `components`, one after the other.
  void add(const S* v, S* f, int components) const {
    if (!declared()) return;
    const int k = int(matrix_.rows());
    for (int i = 0; i < k; ++i)
      for (int j = 0; j < k; ++j)
        for (int c = 0; c < components; ++c) f[i * components + c] += matrix_(i, j) * v[j * components + c];
  }

  /// Parameters to begin with: not zero, where R has no derivative.
  Eigen::VectorXd start(unsigned seed) const {
    std::mt19937 generator(seed);
    Eigen::VectorXd theta(size());
    for (double& x : theta) x = 0.5 * (double(generator()) / 4294967296.0) - 0.25;
    for (Eigen::Index i = 0, at = 0; at < theta.size(); at += ++i + 1) theta(at) += 0.5;
    return theta;
  }

 private:
  Dissipation dissipation_;
  Square matrix_, factor_;
};

}  // namespace lagroid::learning
