#include <lagroid/solvers/linear_algebra/symmetric_factor_sized.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid {

namespace {

constexpr int begin_of_pack(int i) { return i / RowPack::size * RowPack::size; }

/// `row` from the pack of place i on, with zeros up to that place.
void copy_after(const double* row, int i, int stride, double* out) {
  for (int j = begin_of_pack(i); j < stride; ++j) out[j] = j > i ? row[j] : 0;
}

}  // namespace

SymmetricFactorSized::SymmetricFactorSized(int size, int row_length)
    : size_(size),
      stride_(row_length),
      rows_(std::size_t(size * stride_)),
      inverse_(std::size_t(size)),
      off_(std::size_t(size)),
      order_(std::size_t(size)),
      first_(std::size_t(stride_)),
      second_(std::size_t(stride_)),
      solved_(rows_) {}

void SymmetricFactorSized::compute(const double* a, int stride) {
  for (int i = 0; i < size_; ++i) std::copy(a + i * stride, a + i * stride + size_, row(i));
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
  const double* here = row(k);
  const double diagonal = std::abs(here[k]);
  int r = k;
  double below = 0;
  for (int i = k + 1; i < size_; ++i)
    if (const double x = std::abs(here[i]); x > below) {
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
  const int begin = begin_of_pack(k);
  copy_after(row(k), k, stride_, first_.data());
  for (int i = k + 1; i < size_; ++i) {
    double* here = row(i);
    const double factor = here[k] * inverse;
    add_multiple(here + begin, -factor, first_.data() + begin, stride_ - begin);
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
  const int begin = begin_of_pack(k + 1);
  copy_after(row(k), k + 1, stride_, first_.data());
  copy_after(row(k + 1), k + 1, stride_, second_.data());
  for (int i = k + 2; i < size_; ++i) {
    double* here = row(i);
    const double one = inverse_[at] * here[k] + off_[at] * here[k + 1];
    const double two = off_[at] * here[k] + inverse_[at + 1] * here[k + 1];
    for (int j = begin; j < stride_; j += RowPack::size) {
      RowPack sum = RowPack::load(here + j);
      sum -= one * RowPack::load(first_.data() + j);
      sum -= two * RowPack::load(second_.data() + j);
      sum.store(here + j);
    }
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
  std::swap_ranges(row(i), row(i) + stride_, row(j));
  for (int k = 0; k < size_; ++k) std::swap(row(k)[i], row(k)[j]);
  std::swap(order_[std::size_t(i)], order_[std::size_t(j)]);
}

void SymmetricFactorSized::invert(double* out) const {
  const auto solved = [&](int i) { return solved_.data() + i * stride_; };
  std::fill(solved_.begin(), solved_.end(), 0.0);
  for (int i = 0; i < size_; ++i) solved(i)[order_[std::size_t(i)]] = 1;
  for (int i = 1; i < size_; ++i) subtract_combination(solved(i), row(i), 1, solved(0), i, stride_);
  for (int k = 0; k < size_; ++k) {
    const auto at = std::size_t(k);
    const bool is_pair = off_[at] != 0;
    for (int j = 0; j < stride_; j += RowPack::size) {
      const RowPack first = RowPack::load(solved(k) + j);
      RowPack here = inverse_[at] * first;
      if (is_pair) {
        const RowPack second = RowPack::load(solved(k + 1) + j);
        here += off_[at] * second;
        RowPack next = inverse_[at + 1] * second;
        next += off_[at] * first;
        next.store(solved(k + 1) + j);
      }
      here.store(solved(k) + j);
    }
    k += is_pair;
  }
  for (int j = size_ - 2; j >= 0; --j)
    subtract_combination(solved(j), row(j + 1) + j, stride_, solved(j + 1), size_ - 1 - j, stride_);
  for (int i = 0; i < size_; ++i) {
    double* row = out + order_[std::size_t(i)] * stride_;
    for (int j = 0; j < stride_; j += RowPack::size) RowPack::load(solved(i) + j).store(row + j);
  }
}

}  // namespace lagroid
