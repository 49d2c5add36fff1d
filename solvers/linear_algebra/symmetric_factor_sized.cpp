#include <lagroid/solvers/linear_algebra/symmetric_factor_sized.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid {

SymmetricFactorSized::SymmetricFactorSized(int size)
    : size_(size),
      l_(std::size_t(size) * std::size_t(size)),
      inverse_(std::size_t(size)),
      off_(std::size_t(size)),
      order_(std::size_t(size)),
      permuted_(std::size_t(size)) {}

void SymmetricFactorSized::compute(const double* a) {
  std::copy(a, a + l_.size(), l_.begin());
  negative_ = 0;
  smallest_ = std::numeric_limits<double>::infinity();
  for (int i = 0; i < size_; ++i) order_[std::size_t(i)] = i;
  std::fill(off_.begin(), off_.end(), 0.0);
  for (int k = 0; k < size_;) k += pivot(k);
}

/// Eliminates one or two unknowns; returns how many. Before step k rows k, k + 1, ... hold L in columns 0 ... k-1 and
/// the rest of the matrix in the others.
int SymmetricFactorSized::pivot(int k) {
  constexpr double growth = 0.6403882032022076;  // (1 + sqrt 17) / 8
  const double diagonal = std::abs(row(k)[k]);
  int r = k;
  double below = 0;
  for (int i = k + 1; i < size_; ++i)
    if (const double x = std::abs(row(i)[k]); x > below) {
      below = x;
      r = i;
    }
  // Written so that a NaN, which no pivot can mend, ends here too.
  if (k + 1 == size_ || !(diagonal < growth * below)) return eliminate_one(k);
  double beside = 0;  // largest off the diagonal in row r
  for (int i = k; i < size_; ++i)
    if (i != r) beside = std::max(beside, std::abs(row(r)[i]));
  if (diagonal * beside >= growth * below * below) return eliminate_one(k);
  if (std::abs(row(r)[r]) >= growth * beside) {
    exchange(k, r);
    return eliminate_one(k);
  }
  exchange(k + 1, r);
  return eliminate_two(k);
}

int SymmetricFactorSized::eliminate_one(int k) {
  const double inverse = 1 / note(row(k)[k]);
  inverse_[std::size_t(k)] = inverse;
  const double* first = row(k);
  for (int i = k + 1; i < size_; ++i) {
    double* here = row(i);
    const double factor = here[k] * inverse;
    if (factor != 0)
      for (int j = k + 1; j < size_; ++j) here[j] -= factor * first[j];
    here[k] = factor;
  }
  return 1;
}

int SymmetricFactorSized::eliminate_two(int k) {
  const double a = row(k)[k];
  const double b = row(k + 1)[k];
  const double c = row(k + 1)[k + 1];
  // Bunch and Kaufman take such a block only where a c - b^2 < 0, safely: one eigenvalue of each sign.
  const double determinant = a * c - b * b;
  const double large = 0.5 * (std::abs(a + c) + std::sqrt((a - c) * (a - c) + 4 * b * b));
  note(std::copysign(large, a + c));
  note(determinant / std::copysign(large, a + c));
  const auto at = std::size_t(k);
  inverse_[at] = c / determinant;
  inverse_[at + 1] = a / determinant;
  off_[at] = -b / determinant;
  const double* first = row(k);
  const double* second = row(k + 1);
  for (int i = k + 2; i < size_; ++i) {
    double* here = row(i);
    const double one = inverse_[at] * here[k] + off_[at] * here[k + 1];
    const double two = off_[at] * here[k] + inverse_[at + 1] * here[k + 1];
    for (int j = k + 2; j < size_; ++j) here[j] -= one * first[j] + two * second[j];
    here[k] = one;
    here[k + 1] = two;
  }
  row(k + 1)[k] = 0;
  return 2;
}

/// Counts an eigenvalue of D; a zero one is replaced by a tiny one, so that the caller sees it in `smallest` and
/// nothing overflows.
double SymmetricFactorSized::note(double eigenvalue) {
  negative_ += eigenvalue < 0;
  smallest_ = std::isnan(eigenvalue) ? 0 : std::min(smallest_, std::abs(eigenvalue));
  return std::abs(eigenvalue) < 1e-300 ? 1e-300 : eigenvalue;
}

void SymmetricFactorSized::exchange(int i, int j) {
  if (i == j) return;
  std::swap_ranges(row(i), row(i) + size_, row(j));
  for (int k = 0; k < size_; ++k) std::swap(row(k)[i], row(k)[j]);
  std::swap(order_[std::size_t(i)], order_[std::size_t(j)]);
}

void SymmetricFactorSized::solve_in_place(double* b, int columns) const {
  const int n = size_;
  for (int column = 0; column < columns; ++column) {
    double* x = permuted_.data();
    for (int i = 0; i < n; ++i) x[i] = b[order_[std::size_t(i)] * columns + column];
    for (int i = 1; i < n; ++i) {
      const double* l = row(i);
      double sum = x[i];
      for (int j = 0; j < i; ++j) sum -= l[j] * x[j];
      x[i] = sum;
    }
    double before = 0;  // x of the row above, before D^{-1} took it
    for (int i = 0; i < n; ++i) {
      const auto at = std::size_t(i);
      const double here = x[i];
      x[i] = inverse_[at] * here + (i + 1 < n ? off_[at] * x[i + 1] : 0) + (i > 0 ? off_[at - 1] * before : 0);
      before = here;
    }
    for (int i = n - 1; i > 0; --i) {
      const double* l = row(i);
      for (int j = 0; j < i; ++j) x[j] -= l[j] * x[i];
    }
    for (int i = 0; i < n; ++i) b[order_[std::size_t(i)] * columns + column] = x[i];
  }
}

}  // namespace lagroid
