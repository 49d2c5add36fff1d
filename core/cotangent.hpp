#pragma once
/// The cotangent groupoid T*G => A*G of a Lie groupoid G => Q, itself a groupoid of ours: arrows are covectors p in
/// T*_gG, objects are points (q, mu) of A*G.
///
/// It is a symplectic groupoid: steps of a discrete Lagrangian system are points of a Lagrangian submanifold of it, and
/// what is proved of steps is proved there.
///
///     const CotangentGroupoid<Pair<1>> cotangent{};
///     const DualPoint<Vector<double, 1>, double, 1> z{q, mu};
///     const auto p = cotangent.tau(z, Vector<double, 2>(0.3, -1));  // a covector with source z
///
/// Requires a groupoid with local bisections and a chart of its objects (LieGroupoid supplies both where its objects
/// are an open set of R^d). Returns covectors by their values on a basis of T_gG (TangentBasis). Errors are those of G.
///
/// Source: [G] 2.1 and Theorem A.2.

#include <lagroid/core/groupoid.hpp>

#include <string>

namespace lagroid {

/// The dimension of G: of the source fibres and of the objects together.
template <class G> constexpr int total_dimension_of() { return G::dimension + object_dimension_of<G>(); }

/// Tangent vectors of G, given as arrows over dual numbers, and their components in a basis of T_gG: first the
/// left-invariant fields X<-_1 ... X<-_n of the fibre's basis, then U_1 ... U_d, the displacements of the source along
/// the bisection through g.
template <Groupoid G> class TangentBasis {
 public:
  static constexpr int n = G::dimension;
  static constexpr int d = object_dimension_of<G>();
  static constexpr int size = n + d;

  /// Refers to the groupoid.
  explicit TangentBasis(const G& groupoid) : groupoid_(groupoid) {}
  explicit TangentBasis(G&&) = delete;

  /// The components of the tangent vector `k` at g, the value part of k.
  template <class S, class A, class K> Vector<S, size> components(const A& g, const K& k) const {
    using D = Dual<S>;
    const auto gd = groupoid_.template cast<D>(g);
    const auto q = groupoid_.source(k);
    const auto vertical = groupoid_.tau_inverse(groupoid_.multiply(groupoid_.inverse(groupoid_.bisection(gd, q)), k));
    const auto along = groupoid_.object_displacement(groupoid_.source(gd), q);
    Vector<S, size> out;
    for (int i = 0; i < n; ++i) out(i) = vertical(i).derivative;
    for (int j = 0; j < d; ++j) out(n + j) = along(j).derivative;
    return out;
  }

  /// The i-th basis vector at g.
  template <class S, class A> auto vector(const A& g, int i) const {
    const auto gd = groupoid_.template cast<Dual<S>>(g);
    return i < n ? left<S>(gd, Vector<S, n>(Vector<S, n>::Unit(i))) : along_bisection<S>(gd, i - n);
  }
  /// X<-(g) and X->(g) as arrows over dual numbers, x the coefficients of X at the target and at the source.
  template <class S, class K> K left(const K& g, const Vector<S, n>& x) const {
    return groupoid_.multiply(g, groupoid_.tau(groupoid_.target(g), infinitesimal(x)));
  }
  template <class S, class K> K right(const K& g, const Vector<S, n>& x) const {
    return groupoid_.multiply(groupoid_.inverse(groupoid_.tau(groupoid_.source(g), infinitesimal(Vector<S, n>(-x)))),
                              g);
  }
  /// U_j at g: its source displaced along the bisection b_g.
  template <class S, class K> K along_bisection(const K& g, int j) const {
    return groupoid_.bisection(g, displaced<S>(groupoid_.source(g), j));
  }
  /// The same for the target: along the inverse of the bisection through g^{-1}.
  template <class S, class K> K along_inverse_bisection(const K& g, int j) const {
    return groupoid_.inverse(groupoid_.bisection(groupoid_.inverse(g), displaced<S>(groupoid_.target(g), j)));
  }

 private:
  template <class S, class Q> auto displaced(const Q& q, int j) const {
    return groupoid_.displace_object(q, infinitesimal(Vector<S, d>(Vector<S, d>::Unit(j))));
  }

  const G& groupoid_;
};

/// A covector at an arrow: its values on the basis of T_gG (TangentBasis).
template <class Arrow, class S, int Size> struct Covector {
  Arrow arrow;
  Vector<S, Size> values;
};

/// A point (q, mu) of A*G over any scalar.
template <class Object, class S, int Rank> struct DualPoint {
  Object object;
  Vector<S, Rank> momentum;
};

/// Arrows: covectors p in T*_gG. Objects: points (q, mu) of A*G. [G] 2.1 and A.3
///
///     source  <alpha(p), X> = <p, X->(g)>,   target  <beta(p), X> = <p, X<-(g)>      ([G] (4))
///     unit    <eps(mu), v> = <mu, v - T(eps o alpha) v>,   inverse  <i(p), T i(v)> = -<p, v>
///     product by Theorem A.2, with the groupoid's own local bisections.
///
/// Algebroid: T*(A*G); the anchor is the Poisson tensor of A*G. Retraction: tau((q, mu), (x, y)) is the covector at
/// tau(q, x) that has source (q, mu) and the values y on the displacements of the target (TangentBasis). Memory: the
/// arrow, then the values.
template <Groupoid G> struct CotangentGroupoid : LieGroupoid<CotangentGroupoid<G>, total_dimension_of<G>()> {
  static constexpr int rank = G::dimension;
  static constexpr int base = object_dimension_of<G>();
  static constexpr int size = rank + base;
  template <class S> using Arrow = Covector<typename G::template Arrow<S>, S, size>;
  template <class S> using Object = DualPoint<typename G::template Object<S>, S, rank>;
  static constexpr int arrow_size = G::arrow_coordinate_count() + size;
  static constexpr int object_size = G::object_coordinate_count() + rank;
  static constexpr int object_dimension = size;

  [[no_unique_address]] G groupoid;

  CotangentGroupoid() = default;
  explicit CotangentGroupoid(const G& g) : groupoid(g) {}

  template <class A, class S>
  DualPoint<typename G::template Object<S>, S, rank> source(const Covector<A, S, size>& p) const {
    const auto gd = groupoid.template cast<Dual<S>>(p.arrow);
    Vector<S, rank> mu;
    for (int i = 0; i < rank; ++i)
      mu(i) = on(p, basis().template right<S>(gd, Vector<S, rank>(Vector<S, rank>::Unit(i))));
    return {groupoid.source(p.arrow), mu};
  }
  template <class A, class S>
  DualPoint<typename G::template Object<S>, S, rank> target(const Covector<A, S, size>& p) const {
    return {groupoid.target(p.arrow), p.values.template head<rank>()};
  }
  template <class Q, class S>
  Covector<typename G::template Arrow<S>, S, size> unit(const DualPoint<Q, S, rank>& z) const {
    Vector<S, size> values = Vector<S, size>::Constant(S(0.0));
    values.template head<rank>() = z.momentum;
    return {groupoid.unit(z.object), values};
  }
  template <class A, class S> Covector<A, S, size> inverse(const Covector<A, S, size>& p) const {
    return covector<S>(groupoid.inverse(p.arrow), [&](const auto& k) { return -on(p, groupoid.inverse(k)); });
  }
  /// [G] Theorem A.2 with B1 the bisection through g1 and B2 the inverse of that through g2^{-1}.
  template <class A, class S>
  Covector<A, S, size> multiply(const Covector<A, S, size>& p1, const Covector<A, S, size>& p2) const {
    using D = Dual<S>;
    const auto g1 = groupoid.template cast<D>(p1.arrow);
    const auto g2_inverse = groupoid.template cast<D>(groupoid.inverse(p2.arrow));
    const Vector<S, rank> mu = p1.values.template head<rank>();
    return covector<S>(groupoid.multiply(p1.arrow, p2.arrow), [&](const auto& k) {
      const auto from_left = groupoid.multiply(groupoid.inverse(groupoid.bisection(g1, groupoid.source(k))), k);
      const auto by_right = groupoid.bisection(g2_inverse, groupoid.target(k));
      return on(p2, from_left) + on(p1, groupoid.multiply(k, by_right)) -
             at_unit(mu, groupoid.multiply(from_left, by_right));
    });
  }
  template <class Q, class S>
  Covector<typename G::template Arrow<S>, S, size> tau(const DualPoint<Q, S, rank>& z, const Vector<S, size>& v) const {
    return with_source(groupoid.tau(z.object, Vector<S, rank>(v.template head<rank>())), z.momentum,
                       Vector<S, base>(v.template tail<base>()));
  }
  template <class A, class S> Vector<S, size> tau_inverse(const Covector<A, S, size>& p) const {
    Vector<S, size> v;
    v << groupoid.tau_inverse(p.arrow), target_values(p);
    return v;
  }
  template <class A, class Q, class S>
  Covector<A, S, size> bisection(const Covector<A, S, size>& p, const DualPoint<Q, S, rank>& z) const {
    return with_source(groupoid.bisection(p.arrow, z.object), z.momentum, target_values(p));
  }
  template <class A, class S> Covector<A, S, size> project(const Covector<A, S, size>& p) const {
    return {groupoid.project(p.arrow), p.values};
  }
  template <class Q, class S, class U>
  DualPoint<Q, S, rank> displace_object(const DualPoint<Q, S, rank>& z, const U& u) const {
    return {groupoid.displace_object(z.object, Vector<S, base>(u.template head<base>())),
            z.momentum + u.template tail<rank>()};
  }
  template <class Q, class S>
  Vector<S, size> object_displacement(const DualPoint<Q, S, rank>& z, const DualPoint<Q, S, rank>& r) const {
    Vector<S, size> u;
    u << groupoid.object_displacement(z.object, r.object), r.momentum - z.momentum;
    return u;
  }

  template <class A, class S> Vector<S, arrow_size> coordinates(const Covector<A, S, size>& p) const {
    Vector<S, arrow_size> x;
    x << groupoid.coordinates_of_arrow(p.arrow), p.values;
    return x;
  }
  template <class S, class V> Arrow<S> arrow(const V& x) const {
    return {groupoid.template arrow_at<S>(x.template head<arrow_size - size>().eval()), x.template tail<size>()};
  }
  template <class Q, class S> Vector<S, object_size> object_coordinates(const DualPoint<Q, S, rank>& z) const {
    Vector<S, object_size> x;
    x << groupoid.coordinates_of_object(z.object), z.momentum;
    return x;
  }
  template <class S, class V> Object<S> object(const V& x) const {
    return {groupoid.template object_at<S>(x.template head<object_size - rank>().eval()), x.template tail<rank>()};
  }
  static std::string name() { return "T*(" + G::name() + ")"; }

  /// The covector at g with source (alpha(g), mu) and the values y on the displacements of the target: the unit mu
  /// moved to the right along the bisection, and a covector of Q pulled back by beta.
  template <class A, class S>
  Covector<A, S, size> with_source(const A& g, const Vector<S, rank>& mu, const Vector<S, base>& y) const {
    using D = Dual<S>;
    const auto g_inverse = groupoid.template cast<D>(groupoid.inverse(g));
    const auto end = groupoid.template cast_object<D>(groupoid.target(g));
    return covector<S>(g, [&](const auto& k) {
      const auto q = groupoid.target(k);
      S sum = at_unit(mu, groupoid.multiply(k, groupoid.bisection(g_inverse, q)));
      const auto u = groupoid.object_displacement(end, q);
      for (int j = 0; j < base; ++j) sum += y(j) * u(j).derivative;
      return sum;
    });
  }
  /// <p, v>, the tangent vector v given as an arrow over dual numbers.
  template <class A, class S, class K> S on(const Covector<A, S, size>& p, const K& v) const {
    const Vector<S, size> c = basis().template components<S>(p.arrow, v);
    S sum(0.0);
    for (int i = 0; i < size; ++i) sum += p.values(i) * c(i);
    return sum;
  }

 private:
  TangentBasis<G> basis() const { return TangentBasis<G>(groupoid); }

  /// The covector at g with the values f(v) on the basis vectors v.
  template <class S, class A, class F> Covector<A, S, size> covector(const A& g, const F& f) const {
    Covector<A, S, size> p{g, {}};
    for (int i = 0; i < size; ++i) p.values(i) = f(basis().template vector<S>(g, i));
    return p;
  }
  /// <mu, v - T(eps o alpha) v> for a tangent vector v at a unit.
  template <class S, class K> S at_unit(const Vector<S, rank>& mu, const K& v) const {
    const auto x = groupoid.tau_inverse(v);
    S sum(0.0);
    for (int i = 0; i < rank; ++i) sum += mu(i) * x(i).derivative;
    return sum;
  }
  template <class A, class S> Vector<S, base> target_values(const Covector<A, S, size>& p) const {
    const auto gd = groupoid.template cast<Dual<S>>(p.arrow);
    Vector<S, base> y;
    for (int j = 0; j < base; ++j) y(j) = on(p, basis().template along_inverse_bisection<S>(gd, j));
    return y;
  }
};

}  // namespace lagroid
