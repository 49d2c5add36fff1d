#pragma once
/// Rows of numbers whose length is known at run time, padded with zeros to whole packs of eight, so that sums over them
/// are a few operations of registers each and no loop has an end of its own.
///
///     std::vector<double> a(std::size_t(padded(5)));  // five numbers and three zeros
///     add_multiple(out, 2, a.data(), padded(5));       // out += 2 a
///
/// Requires rows as long as they are said to be, a multiple of eight, with zeros behind the numbers. Nothing throws.

#include <lagroid/core/types.hpp>

#include <cstring>

namespace lagroid {

/// Eight numbers side by side, in as many registers as the target machine takes.
class RowPack {
 public:
  static constexpr int size = 8;

  RowPack() = default;
  LAGROID_INLINE static RowPack load(const double* x) {
    RowPack out;
    std::memcpy(&out.numbers_, x, sizeof out.numbers_);
    return out;
  }
  LAGROID_INLINE void store(double* x) const { std::memcpy(x, &numbers_, sizeof numbers_); }

  LAGROID_INLINE RowPack& operator+=(const RowPack& a) {
    numbers_ += a.numbers_;
    return *this;
  }
  LAGROID_INLINE RowPack& operator-=(const RowPack& a) {
    numbers_ -= a.numbers_;
    return *this;
  }
  LAGROID_INLINE friend RowPack operator*(const RowPack& a, const RowPack& b) {
    return RowPack(a.numbers_ * b.numbers_);
  }
  LAGROID_INLINE friend RowPack operator*(double s, const RowPack& a) { return RowPack(s * a.numbers_); }
  LAGROID_INLINE double sum() const {
    return ((numbers_[0] + numbers_[4]) + (numbers_[1] + numbers_[5])) +
           ((numbers_[2] + numbers_[6]) + (numbers_[3] + numbers_[7]));
  }

 private:
  using Numbers [[gnu::vector_size(size * sizeof(double))]] = double;
  LAGROID_INLINE explicit RowPack(const Numbers& numbers) : numbers_(numbers) {}
  Numbers numbers_;
};

/// How long a row of n numbers is with its padding.
constexpr int padded(int n) { return (n + RowPack::size - 1) / RowPack::size * RowPack::size; }

/// out += factor * a.
LAGROID_INLINE inline void add_multiple(double* out, double factor, const double* a, int length) {
  for (int i = 0; i < length; i += RowPack::size) {
    RowPack sum = RowPack::load(out + i);
    sum += factor * RowPack::load(a + i);
    sum.store(out + i);
  }
}

/// out += sum_i a_i row_i over so many rows; a_i stand `step` numbers after one another.
LAGROID_INLINE inline void add_combination(double* out, const double* a, int step, const double* rows, int count,
                                           int length) {
  for (int i = 0; i < length; i += RowPack::size) {
    RowPack even = RowPack::load(out + i);
    RowPack odd = 0.0 * even;  // two sums, that neither wait for the other
    int k = 0;
    for (; k + 1 < count; k += 2) {
      even += a[k * step] * RowPack::load(rows + k * length + i);
      odd += a[(k + 1) * step] * RowPack::load(rows + (k + 1) * length + i);
    }
    if (k < count) even += a[k * step] * RowPack::load(rows + k * length + i);
    even += odd;
    even.store(out + i);
  }
}
LAGROID_INLINE inline void subtract_combination(double* out, const double* a, int step, const double* rows, int count,
                                                int length) {
  for (int i = 0; i < length; i += RowPack::size) {
    RowPack even = RowPack::load(out + i);
    RowPack odd = 0.0 * even;
    int k = 0;
    for (; k + 1 < count; k += 2) {
      even -= a[k * step] * RowPack::load(rows + k * length + i);
      odd -= a[(k + 1) * step] * RowPack::load(rows + (k + 1) * length + i);
    }
    if (k < count) even -= a[k * step] * RowPack::load(rows + k * length + i);
    even += odd;
    even.store(out + i);
  }
}

/// <a, b>.
LAGROID_INLINE inline double sum_of_products(const double* a, const double* b, int length) {
  RowPack sum = RowPack::load(a) * RowPack::load(b);
  for (int i = RowPack::size; i < length; i += RowPack::size) sum += RowPack::load(a + i) * RowPack::load(b + i);
  return sum.sum();
}

}  // namespace lagroid
