#pragma once
/// The Toda lattice in Flaschka's variables: a_i of the springs and b_i of the particles,
///
///     a_i' = a_i (b_{i+1} - b_i),    b_i' = 2 (a_i^2 - a_{i-1}^2),    H = tr L^2 / 2 = sum a_i^2 + b_i^2 / 2,
///
/// L tridiagonal with b on its diagonal and a beside it; its eigenvalues are constant.
///
///     const OpenToda<3> lattice;
///     const double trace = OpenToda<3>::trace_of_cube(Vector<double, 5>(1, 0.5, 0.3, -0.2, 0.7));
///
/// Returns as PoissonSystem. Nothing throws.
///
/// Source: Flaschka, The Toda lattice II, 1974.

#include <lagroid/core/poisson/poisson_system.hpp>

namespace lagroid {

namespace detail {

/// K particles and `Springs` springs, K - 1 or, on a ring, K.
template <class Derived, int K, int Springs> struct Toda : PoissonSystem<Derived, Springs + K> {
  static constexpr int dimension = Springs + K;
  static std::array<std::string, dimension> labels() {
    std::array<std::string, dimension> out;
    for (int i = 0; i < dimension; ++i)
      out[std::size_t(i)] = (i < Springs ? "a" : "b") + std::to_string((i < Springs ? i : i - Springs) + 1);
    return out;
  }
  /// {a_i, b_i} = -a_i, {a_i, b_{i+1}} = a_i.
  static constexpr bool linear_bracket = true;
  template <class S> Matrix<S, dimension, dimension> bivector(const Vector<S, dimension>& x) const {
    auto pi = skew<S, dimension>({});
    for (int i = 0; i < Springs; ++i) {
      set_skew<S>(pi, i, Springs + i, -x(i));
      set_skew<S>(pi, i, Springs + (i + 1) % K, x(i));
    }
    return pi;
  }
  static constexpr int parts = dimension;
  template <class S> S part(int i, const S& x) const { return i < Springs ? S(x * x) : S(x * x * 0.5); }

 protected:
  template <class S> static S sum_of_b(const Vector<S, dimension>& x) {
    S sum = x(Springs);
    for (int i = 1; i < K; ++i) sum += x(Springs + i);
    return sum;
  }
};

}  // namespace detail

/// K particles in a row, x = (a_1 ... a_{K-1}, b_1 ... b_K). Casimir: sum b_i.
template <int K> struct OpenToda : detail::Toda<OpenToda<K>, K, K - 1> {
  using Base = detail::Toda<OpenToda<K>, K, K - 1>;
  template <class S> Vector<S, 1> casimirs(const Vector<S, Base::dimension>& x) const {
    return Vector<S, 1>(Base::sum_of_b(x));
  }
  /// tr L^3, a constant of the motion.
  static double trace_of_cube(const Vector<double, Base::dimension>& x) {
    double sum = 0;
    for (int i = 0; i < K; ++i) sum += x(K - 1 + i) * x(K - 1 + i) * x(K - 1 + i);
    for (int i = 0; i + 1 < K; ++i) sum += 3 * x(i) * x(i) * (x(K - 1 + i) + x(K + i));
    return sum;
  }
};

/// K particles on a ring, x = (a_1 ... a_K, b_1 ... b_K). Casimirs: sum b_i and the product of all a_i.
template <int K> struct PeriodicToda : detail::Toda<PeriodicToda<K>, K, K> {
  using Base = detail::Toda<PeriodicToda<K>, K, K>;
  template <class S> Vector<S, 2> casimirs(const Vector<S, Base::dimension>& x) const {
    S product = x(0);
    for (int i = 1; i < K; ++i) product = product * x(i);
    return Vector<S, 2>(Base::sum_of_b(x), product);
  }
};

}  // namespace lagroid
