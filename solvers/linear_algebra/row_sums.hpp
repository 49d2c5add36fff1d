#pragma once
/// Sums over rows of numbers whose length is known at run time and that stand one after another without padding, as the
/// derivatives of a stage do.
///
///     const double rows[] = {1, 2, 3, 4, 5, 6};
///     const double weights[] = {1, 10};
///     add_rows(out, weights, rows, 2, 3);                 // out += (41, 52, 63)
///     const double sum = row_product(rows, rows + 3, 3);  // 1 4 + 2 5 + 3 6
///
/// Nothing throws.

#include <lagroid/core/scalars/pack.hpp>
#include <lagroid/solvers/linear_algebra/padded_rows.hpp>

namespace lagroid {

/// Calls what<width>(place) for the packs of eight, four, two and one numbers that make up a row.
template <class What> LAGROID_INLINE inline void in_packs(int length, const What& what) {
  int q = 0;
  for (; q + 8 <= length; q += 8) what.template operator()<8>(q);
  for (; q + 4 <= length; q += 4) what.template operator()<4>(q);
  for (; q + 2 <= length; q += 2) what.template operator()<2>(q);
  for (; q < length; ++q) what.template operator()<1>(q);
}

/// out += sum_i weight_i row_i over so many rows of so many numbers.
LAGROID_INLINE inline void add_rows(double* out, const double* weights, const double* rows, int count, int length) {
  in_packs(length, [&]<int Few>(int q) {
    using Numbers = Pack<double, Few>;
    Numbers even = Numbers::load(out + q);
    Numbers odd = 0.0 * even;  // two sums, that neither wait for the other
    int i = 0;
    for (; i + 1 < count; i += 2) {
      even = even + weights[i] * Numbers::load(rows + i * length + q);
      odd = odd + weights[i + 1] * Numbers::load(rows + (i + 1) * length + q);
    }
    if (i < count) even = even + weights[i] * Numbers::load(rows + i * length + q);
    (even + odd).store(out + q);
  });
}

/// <a, b>.
LAGROID_INLINE inline double row_product(const double* a, const double* b, int length) {
  double sum = 0;
  int q = 0;
  for (; q + RowPack::size <= length; q += RowPack::size) sum += (RowPack::load(a + q) * RowPack::load(b + q)).sum();
  for (; q < length; ++q) sum += a[q] * b[q];
  return sum;
}

/// In packs, where a call of memmove would take longer.
LAGROID_INLINE inline void copy_row(const double* from, int length, double* to) {
  in_packs(length, [&]<int Few>(int q) { Pack<double, Few>::load(from + q).store(to + q); });
}

}  // namespace lagroid
