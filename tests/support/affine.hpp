#pragma once
/// A groupoid that is not of the library, and ways in which it can be wrong.

#include <lagroid/core/groupoid.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>

#include <cmath>
#include <limits>
#include <string>

namespace lagroid {

/// The affine group of the line acting on R: the action groupoid Aff(1) x R => R. Arrow (a, b, x) from x to
/// exp(a) x + b; objects are not a group's single point, arrows are a plain struct, and only the required
/// operations and what its faults need are supplied.
template <class S> struct AffineArrow { S a, b, x; };

enum class Fault {
  none,
  source,
  unit,
  inverse,
  target,
  product,
  retraction,
  inverse_retraction,
  seed,
  momentum_change,
  extension,
  not_a_number,
  bracket,
  anchor,
  bisection,
  object_chart,
  moves_its_source
};

struct Affine : LieGroupoid<Affine, 2> {
  template <class S> using Arrow = AffineArrow<S>;
  template <class S> using Object = Vector<S, 1>;
  static constexpr int arrow_size = 3;
  Fault fault = Fault::none;
  bool has(Fault f) const { return fault == f; }

  template <class S> Object<S> source(const Arrow<S>& g) const {
    return Object<S>(has(Fault::source) ? S(g.x + g.b * 1e-3) : g.x);
  }
  template <class S> Object<S> target(const Arrow<S>& g) const {
    using std::exp;
    return Object<S>(has(Fault::target) ? S(exp(g.a) * g.x + g.b * g.b) : S(exp(g.a) * g.x + g.b));
  }
  template <class S> Arrow<S> unit(const Vector<S, 1>& q) const { return {S(0), S(has(Fault::unit) ? 1e-6 : 0), q(0)}; }
  template <class S> Arrow<S> inverse(const Arrow<S>& g) const {
    using std::exp;
    return {-g.a, has(Fault::inverse) ? S(-g.b) : S(-(exp(-g.a) * g.b)), target(g)(0)};
  }
  template <class S> Arrow<S> multiply(const Arrow<S>& g, const Arrow<S>& h) const {
    using std::exp;
    return {g.a + h.a, has(Fault::product) ? S(g.b + h.b) : S(exp(h.a) * g.b + h.b), g.x};
  }
  template <class S> Arrow<S> tau(const Vector<S, 1>& q, const Vector<S, 2>& v) const {
    return {v(0), has(Fault::retraction) ? S(v(1) + S(1e-3)) : v(1),
            has(Fault::moves_its_source) ? S(q(0) + v(0)) : q(0)};
  }
  template <class S> Vector<S, 2> tau_inverse(const Arrow<S>& g) const {
    if (has(Fault::not_a_number)) return {g.a, S(std::numeric_limits<double>::quiet_NaN())};
    return {g.a, has(Fault::inverse_retraction) ? S(g.b * (S(1) + g.b)) : g.b};
  }
  template <class S> static Vector<S, 3> coordinates(const Arrow<S>& g) { return {g.a, g.b, g.x}; }
  template <class S, class V> static Arrow<S> arrow(const V& x) { return {x(0), x(1), x(2)}; }
  template <class M, End First, End Second, int LeftOffset = 0, int RightOffset = LeftOffset, class A>
  auto seed(const A& g) const {
    auto out = this->template seed_by_composition<M, First, Second, LeftOffset, RightOffset>(g);
    if constexpr (M::order == 2)
      for (int i = 0; i < 2 && has(Fault::seed); ++i)
        for (int j = 0; j < 2; ++j) out.b.set_mixed(i, j, -out.b.mixed(i, j));
    return out;
  }
  template <class A, class V> A extend(const A& g, const V& w) const {
    return LieGroupoid::extend(g, has(Fault::extension) ? V(w * 1.001) : w);
  }
  template <class A, class V> V momentum_change(const A&, const V& source_gradient, const V& target_gradient) const {
    return V((source_gradient + target_gradient) * (has(Fault::momentum_change) ? 1.001 : 1.0));
  }
  template <class S> Vector<S, 2> bracket(const Vector<S, 1>&, const Vector<S, 2>& x, const Vector<S, 2>& y) const {
    const S b = y(0) * x(1) - x(0) * y(1);
    return {S(0), has(Fault::bracket) ? S(-b) : b};
  }
  template <class S> Vector<S, 1> anchor(const Vector<S, 1>& q, const Vector<S, 2>& x) const {
    return Vector<S, 1>(has(Fault::anchor) ? S(x(1) * q(0) + x(0)) : S(x(0) * q(0) + x(1)));
  }
  template <class S> Arrow<S> bisection(const Arrow<S>& g, const Vector<S, 1>& q) const {
    return {g.a, has(Fault::bisection) ? S(g.b + q(0) - g.x + g.b * 1e-3) : g.b, q(0)};
  }
  template <class S> Vector<S, 1> object_displacement(const Vector<S, 1>& q, const Vector<S, 1>& r) const {
    return (r - q) * (has(Fault::object_chart) ? 2.0 : 1.0);
  }
  static std::string name() { return "Aff(1) x R"; }
};

/// Samples that exp does not make large.
inline laws::GroupoidLawOptions moderate() {
  laws::GroupoidLawOptions o;
  o.large = 2;
  return o;
}

}  // namespace lagroid
