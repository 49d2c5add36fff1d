#pragma once
/// The Lie algebroid AG => Q of a Lie groupoid: the anchor rho : AG -> TQ, the bracket [X, Y] of sections, and the
/// structure functions of its frame.
///
/// They are computed from the groupoid's own operations by differentiation, so that the Poisson structure of A*G needs
/// no formula of the user's.
///
///     const LieAlgebroid<SO3> algebroid(groupoid);  // refers to the groupoid
///     const auto x = [](const auto&) { return Vector<double, 3>(1, 0, 0); };
///     const auto z = algebroid.bracket(q, x, [](const auto&) { return Vector<double, 3>(0, 1, 0); });  // (0, 0, 1)
///
/// Requires sections that take objects over any scalar, and a frame that is smooth around the objects at which they are
/// evaluated. Returns vectors over the scalar of q, in the basis of A_qG. Nothing throws.
///
/// Source: [G] Def. 2.7, 2.9.

#include <lagroid/core/groupoid.hpp>

#include <array>

namespace lagroid {

/// The scalar over which an object of G is given.
template <class G, class Q>
using ObjectScalar = typename decltype(std::declval<G>().coordinates_of_object(std::declval<Q>()))::Scalar;

/// A groupoid **may** supply the bracket of its frame in closed form, for speed:
///
///     Vector<S, dimension> bracket(const Object<S>& q, const Vector<S, dimension>& x, const Vector<S, dimension>& y)
///
/// the value at q of the bracket of the sections with constant coefficients x and y.
template <class G>
concept HasAnalyticBracket = requires(const G& groupoid, const ObjectOf<G>& q, const AlgebroidVector<G>& x) {
  { groupoid.bracket(q, x, x) } -> std::convertible_to<AlgebroidVector<G>>;
};

/// AG => Q with anchor and bracket ([G] Def. 2.7, 2.9), computed from the groupoid by differentiation.
///
/// Vectors of A_qG are written in the basis that the retraction fixes there. As q varies these bases form the frame
/// e_1 ... e_n of AG, which must be smooth around q (on the branch that the groupoid's code takes there; no frame need
/// be smooth everywhere). A section is a callable that takes an object over any scalar S and returns its
/// coefficients, a Vector<S, n> or a constant Vector<double, n>.
template <Groupoid G> class LieAlgebroid {
 public:
  static constexpr int rank = G::dimension;
  template <class S> using Fibre = Vector<S, rank>;

  /// Refers to the groupoid.
  explicit LieAlgebroid(const G& groupoid) : groupoid_(groupoid) {}
  explicit LieAlgebroid(G&&) = delete;

  /// rho(x) in T_qQ, in object coordinates. [G] Def. 2.9
  template <class Q, class V> auto anchor(const Q& q, const V& x) const { return groupoid_.anchor(q, x); }

  /// The section's value at q, over the scalar of q.
  template <class Section, class Q> auto value(const Section& section, const Q& q) const {
    return Fibre<ObjectScalar<G, Q>>(section(q).template cast<ObjectScalar<G, Q>>());
  }

  /// rho(x)[f]: the derivative at q along the anchor of x, component by component, of a function f that takes objects
  /// over any scalar to vectors.
  template <class Q, class V, class F> auto along_anchor(const Q& q, const V& x, const F& f) const {
    using S = ObjectScalar<G, Q>;
    using D = Dual<S>;
    const auto moved =
        groupoid_.target(groupoid_.tau(groupoid_.template cast_object<D>(q), infinitesimal(Fibre<S>(x))));
    return derivative_of(f(moved));
  }

  /// The bracket at q of the sections of constant coefficients x and y, from the bracket of their left-invariant fields
  /// at the unit, [X, Y]<- = [X<-, Y<-].
  template <class Q, class V> auto automatic_frame_bracket(const Q& q, const V& x, const V& y) const {
    return fields_bracket(
        q, [&](const auto&) { return x; }, [&](const auto&) { return y; });
  }
  /// The same: the groupoid's own where it has one.
  template <class Q, class V> auto frame_bracket(const Q& q, const V& x, const V& y) const {
    if constexpr (HasAnalyticBracket<G>) {
      return Fibre<ObjectScalar<G, Q>>(groupoid_.bracket(q, x, y));
    } else {
      return automatic_frame_bracket(q, x, y);
    }
  }

  /// [X, Y](q) = [x, y] + rho(x)[Y] - rho(y)[X] with the constant sections x = X(q), y = Y(q).
  template <class Q, class X, class Y> auto bracket(const Q& q, const X& x, const Y& y) const {
    const auto xq = value(x, q);
    const auto yq = value(y, q);
    const auto along = [&](const auto& v, const auto& section) {
      return along_anchor(q, v, [&](const auto& r) { return value(section, r); });
    };
    return Fibre<ObjectScalar<G, Q>>(frame_bracket(q, xq, yq) + along(xq, y) - along(yq, x));
  }

  /// [X, Y](q) as the bracket of the left-invariant fields at the unit: the definition.
  template <class Q, class X, class Y> auto fields_bracket(const Q& q, const X& x, const Y& y) const {
    using S = ObjectScalar<G, Q>;
    const auto unit = groupoid_.unit(q);
    const auto vertical = left_fields_bracket(unit, x, y);
    const auto v = groupoid_.tau_inverse(groupoid_.with_tangent(unit, vertical));
    Fibre<S> out;
    for (int i = 0; i < rank; ++i) out(i) = v(i).derivative;
    return out;
  }

  /// [X<-, Y<-](g), the Jacobi-Lie bracket of vector fields on G, in arrow coordinates.
  template <class A, class X, class Y> auto left_fields_bracket(const A& g, const X& x, const Y& y) const {
    const auto moved = [&](const auto& k, const auto& section, const auto& size) {
      const auto q = groupoid_.target(k);
      return groupoid_.multiply(k, groupoid_.tau(q, times(size, value(section, q))));
    };
    return fields_bracket_at(g, x, y, moved);
  }
  /// [X->, Y->](g), likewise.
  template <class A, class X, class Y> auto right_fields_bracket(const A& g, const X& x, const Y& y) const {
    const auto moved = [&](const auto& k, const auto& section, const auto& size) {
      const auto q = groupoid_.source(k);
      return groupoid_.multiply(groupoid_.inverse(groupoid_.tau(q, times(size, value(section, q)))), k);
    };
    return fields_bracket_at(g, x, y, moved);
  }

  /// The structure functions at q: entry (i, j) of the k-th matrix is the k-th component of [e_i, e_j].
  template <class Q> auto structure_functions(const Q& q) const {
    using S = ObjectScalar<G, Q>;
    std::array<Matrix<S, rank, rank>, std::size_t(rank)> c;
    for (int i = 0; i < rank; ++i)
      for (int j = 0; j < rank; ++j) {
        const Fibre<S> b = frame_bracket(q, Fibre<S>(Fibre<S>::Unit(i)), Fibre<S>(Fibre<S>::Unit(j)));
        for (int k = 0; k < rank; ++k) c[std::size_t(k)](i, j) = b(k);
      }
    return c;
  }

 private:
  template <class T, class V> static V times(const T& size, V v) {
    for (int i = 0; i < v.size(); ++i) v(i) = v(i) * size;
    return v;
  }

  /// With t and s infinitesimal, the mixed derivative d/dt d/ds of moved(moved(g, X, t), Y, s) is D Y<- . X<- (and with
  /// X and Y exchanged, D X<- . Y<-).
  template <class A, class X, class Y, class Move>
  auto fields_bracket_at(const A& g, const X& x, const Y& y, const Move& moved) const {
    using S = typename decltype(groupoid_.coordinates_of_arrow(g))::Scalar;
    using D = Dual<Dual<S>>;
    const D t(Dual<S>(S(0.0)), Dual<S>(S(1.0)));
    const D s(Dual<S>(S(0.0), S(1.0)), Dual<S>(S(0.0)));
    const auto start = groupoid_.template cast<D>(groupoid_.template cast<Dual<S>>(g));
    const auto derivative = [&](const auto& first, const auto& second) {
      const auto c = groupoid_.coordinates_of_arrow(moved(moved(start, first, t), second, s));
      return c.unaryExpr([](const D& z) { return z.derivative.derivative; }).eval();
    };
    return (derivative(x, y) - derivative(y, x)).eval();
  }

  const G& groupoid_;
};

}  // namespace lagroid
