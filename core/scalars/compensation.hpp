#pragma once
/// Compensated sums: what rounding takes from a sum is kept, and added with the next term.
///
/// A million steps added one by one lose digits by the rounding of every addition; a compensated sum does not.
///
///     Compensation<double> compensation{0};
///     double time = 0;
///     for (int k = 0; k < 1000000; ++k) compensation.add(time, 1e-3);
///
/// Source: Kahan 1965; Hairer, Lubich, Wanner VIII.5.

namespace lagroid {

/// What rounding has taken from a sum of numbers or vectors: it is given back as soon as it can be stored.
template <class T> struct Compensation {
  T lost;

  /// sum <- sum + increment.
  void add(T& sum, const T& increment) {
    lost += increment;
    const T next = sum + lost;
    lost -= next - sum;
    sum = next;
  }
};

}  // namespace lagroid
