#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/systems/optimisation/extreme_eigenvalues.hpp>

#include <algorithm>

namespace lagroid::optimisation {

namespace {

/// The size of Lanczos' basis, below which there is nothing to iterate.
constexpr Eigen::Index small = 24;

Eigen::VectorXd dense_eigenvalues(const SymmetricOperator& a) {
  Eigen::MatrixXd matrix(a.size, a.size);
  a.apply(Eigen::MatrixXd::Identity(a.size, a.size), matrix);
  return symmetric_eigenvalues(matrix);
}

}  // namespace

double entry_of(const SymmetricOperator& a, Eigen::Index i, Eigen::Index j) {
  const Eigen::MatrixXd unit = Eigen::VectorXd::Unit(a.size, j);
  Eigen::MatrixXd column(a.size, 1);
  a.apply(unit, column);
  return column(i);
}

SymmetricOperator with_changed_entry(const SymmetricOperator& a, Eigen::Index i, Eigen::Index j, double by) {
  return {a.size, [a, i, j, by](const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::Ref<Eigen::MatrixXd> y) {
            a.apply(x, y);
            y.row(i) += by * x.row(j);
            if (i != j) y.row(j) += by * x.row(i);
          }};
}

std::pair<double, double> spectrum(const SymmetricOperator& a) {
  if (a.size <= small) {
    const Eigen::VectorXd all = dense_eigenvalues(a);
    return {all(0), all(a.size - 1)};
  }
  constexpr double tolerance = 1e-4;
  const Eigen::VectorXd ends = extreme_eigenvalues(a, SpectrumEnd::both, 2, small, tolerance);
  const double margin = tolerance * (ends(0) - ends(1));
  return {ends(1) - margin, ends(0) + margin};
}

Eigen::VectorXd smallest_eigenvalues(const SymmetricOperator& a, Eigen::Index count) {
  constexpr Eigen::Index cheap = 500;  // a second, and two digits more than Lanczos' iteration gives
  if (a.size <= std::max(cheap, 2 * count)) return dense_eigenvalues(a).head(count);
  constexpr double tolerance = 1e-14;
  return extreme_eigenvalues(a, SpectrumEnd::smallest, count, std::max(small, 4 * count), tolerance).reverse();
}

}  // namespace lagroid::optimisation
