#pragma once
/// The local symplectic groupoid of a Poisson manifold as a groupoid of ours: arrows (x, u) by a chart, from x.
///
///     alpha(x, u) = x,    beta(x, u) = the chart's end,    unit (x, 0),    inverse (beta, -u)
///
/// The graph of p = dS(middle) is a Lagrangian bisection of it, and the map alpha -> beta along a Lagrangian bisection
/// is a Poisson map: that is a step. Products of bisections compose the maps.
///
///     const SymplecticGroupoid<CayleyChart<EulerTop>> groupoid;
///     const auto g = groupoid.tau(Vector<double, 3>(1, 0, 0), Vector<double, 3>(0, 0.1, 0));
///     const auto canonical = groupoid.darboux(g);  // (middle, p)
///
/// Requires a chart (charts.hpp) and arrows near units, where it is defined. Returns, for arrows over a scalar S,
/// arrows and objects over S. Errors are those of LieGroupoid.
///
/// Source: Weinstein, Symplectic groupoids and Poisson manifolds, 1987; Karasev 1987.

#include <lagroid/core/groupoid.hpp>
#include <lagroid/groupoids/poisson/charts.hpp>

#include <string>
#include <utility>

namespace lagroid {

template <class Chart> class SymplecticGroupoid : public LieGroupoid<SymplecticGroupoid<Chart>, Chart::size> {
 public:
  static constexpr int n = Chart::size;
  template <class S> using Arrow = Vector<S, 2 * n>;
  template <class S> using Object = Vector<S, n>;

  explicit SymplecticGroupoid(Chart chart = Chart()) : chart_(std::move(chart)) {}

  template <class S> Vector<S, n> source(const Vector<S, 2 * n>& g) const { return part<0, n>(g); }
  template <class S> Vector<S, n> target(const Vector<S, 2 * n>& g) const {
    return chart_.from(part<0, n>(g), part<n, n>(g)).end;
  }
  template <class S> Vector<S, 2 * n> unit(const Vector<S, n>& x) const {
    return joined(x, constants<S>(Vector<double, n>(Vector<double, n>::Zero())));
  }
  template <class S> Vector<S, 2 * n> inverse(const Vector<S, 2 * n>& g) const {
    Vector<S, n> back;
    for (int i = 0; i < n; ++i) back(i) = -g(n + i);
    return joined(target(g), back);
  }
  template <class S> Vector<S, 2 * n> multiply(const Vector<S, 2 * n>& g, const Vector<S, 2 * n>& h) const {
    return joined(part<0, n>(g), chart_.product(part<0, n>(g), part<n, n>(g), part<n, n>(h)));
  }
  template <class S> Vector<S, 2 * n> tau(const Vector<S, n>& x, const Vector<S, n>& u) const { return joined(x, u); }
  template <class S> Vector<S, n> tau_inverse(const Vector<S, 2 * n>& g) const { return part<n, n>(g); }

  /// (middle, p), canonical coordinates of the arrows.
  template <class S> Vector<S, 2 * n> darboux(const Vector<S, 2 * n>& g) const {
    const auto middle = chart_.from(part<0, n>(g), part<n, n>(g)).middle;
    return joined(middle, chart_.momentum(middle, part<n, n>(g)));
  }
  /// pi at an object.
  template <class S> Matrix<S, n, n> bivector(const Vector<S, n>& x) const { return chart_.bivector(x); }
  const Chart& darboux_chart() const { return chart_; }
  static std::string name() { return Chart::name(); }

 private:
  [[no_unique_address]] Chart chart_;
};

}  // namespace lagroid
