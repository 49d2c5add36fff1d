#pragma once
/// Source and target of the local symplectic groupoid as truncated sums of trees, with f^i(x; p) = pi^{ij}(x) p_j and
/// derivatives by x at fixed p,
///
///     alpha(x, p) = x - f/2 + f'f/12 - f''(f, f)/48 + O(p^4),    beta(x, p) = alpha(x, -p),
///
/// K = 1 or 3 orders of p: explicit, and Poisson up to the order at which the sum was cut.
///
///     const TreeChart<LotkaVolterra, 3> chart{LotkaVolterra{}};
///     const auto from = chart.source(Vector<double, 2>(2, 0.5), Vector<double, 2>(0.1, -0.2));
///
/// The step of K = 1 is the implicit midpoint rule. (K = 2 gains no order over it where pi is not linear: errors of
/// even powers cancel between source and target.) Returns points over the scalar of the arguments. Nothing throws.
///
/// Source: Cabrera, Martin de Diego, Vaquero, arXiv 2409.04342.

#include <lagroid/core/poisson/poisson_system.hpp>
#include <lagroid/core/scalars/series.hpp>

#include <utility>

namespace lagroid {

template <class Sys, int K> struct TreeChart {
  static_assert(K == 1 || K == 3);
  static constexpr int size = Sys::dimension;
  Sys system;

  TreeChart() = default;
  explicit TreeChart(Sys of) : system(std::move(of)) {}
  template <class S> Matrix<S, size, size> bivector(const Vector<S, size>& x) const { return system.bivector(x); }

  template <class S> Vector<S, size> source(const Vector<S, size>& x, const Vector<S, size>& p) const {
    return end(x, p, 1);
  }
  template <class S> Vector<S, size> target(const Vector<S, size>& x, const Vector<S, size>& p) const {
    return end(x, p, -1);
  }

 private:
  /// Odd orders change their sign with p.
  template <class S> Vector<S, size> end(const Vector<S, size>& x, const Vector<S, size>& p, double sign) const {
    const Vector<S, size> f = system.field(x, p);
    Vector<S, size> out;
    if constexpr (K == 1) {
      for (int i = 0; i < size; ++i) out(i) = x(i) - f(i) * (0.5 * sign);
    } else {
      // f(x + t f) = f + t f'f + t^2 f''(f, f) / 2.
      using Along = Series<S, 3>;
      Vector<Along, size> at;
      for (int i = 0; i < size; ++i) {
        at(i) = Along(x(i));
        at(i)[1] = f(i);
      }
      const Vector<Along, size> along = system.field(at, constants<Along>(p));
      for (int i = 0; i < size; ++i)
        out(i) = x(i) - f(i) * (0.5 * sign) + along(i)[1] * (1.0 / 12) - along(i)[2] * (sign / 24);
    }
    return out;
  }
};

}  // namespace lagroid
