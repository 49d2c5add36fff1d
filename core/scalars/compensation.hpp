#pragma once
/// Sums with compensation.

namespace lagroid {

/// What rounding has taken from a sum of numbers or vectors: it is given back as soon as it can be stored. (Kahan 1965;
/// Hairer, Lubich, Wanner VIII.5)
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
