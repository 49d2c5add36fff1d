#pragma once
/// Lie groupoids G => Q: arrows g in G and objects q in Q, a source alpha and a target beta, a unit at every object, an
/// inverse of every arrow, and a product g h of two arrows with beta(g) = alpha(h).
///
/// Pairs of points, Lie groups, group actions and products of these are all groupoids, so that a method written once
/// for arrows serves particles, rigid bodies and rolling bodies alike.
///
/// The fibre A_qG of the Lie algebroid AG is the tangent space of alpha^{-1}(q) at the unit. A *retraction* tau_q :
/// A_qG -> alpha^{-1}(q), tau_q(0) = unit(q), parametrises the arrows near the unit by `dimension` numbers; its
/// derivative at 0 fixes the basis in which vectors of AG and momenta of A*G are written throughout.
///
///     const Pair<2> groupoid;
///     const auto g = groupoid.tau(Vector<double, 2>(0, 0), Vector<double, 2>(1, 2));  // from (0, 0) to (1, 2)
///     const auto square = groupoid.compose(g, groupoid.extend(groupoid.unit(groupoid.target(g)), w));
///
/// Requires of a groupoid of one's own: seven operations, listed at `LieGroupoid`, that satisfy the axioms;
/// laws::groupoid_laws tests them. Returns, for arrows over a scalar S, arrows and objects over S.
///
/// Errors: `compose` throws NotComposable in checked builds (LAGROID_CHECKED) where beta(g) differs from alpha(h), and
/// `require_initial_end` std::invalid_argument; nothing else throws. Where tau_inverse has no value, its numbers are
/// not finite or those of another branch.
///
/// Source: [G] Def. 2.1, 2.4, 2.9.

#include <lagroid/core/scalars/dual.hpp>
#include <lagroid/core/scalars/hyper_dual.hpp>
#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

namespace lagroid {

/// Thrown by `compose` in checked builds (LAGROID_CHECKED) when beta(g) differs from alpha(h).
class NotComposable : public std::domain_error {
  using std::domain_error::domain_error;
};

#ifdef LAGROID_CHECKED
inline constexpr bool checked_build = true;
#else
inline constexpr bool checked_build = false;
#endif

/// Which end of an arrow an infinitesimal displaces.
enum class End { source, target };

namespace detail {

/// Objects and arrows that are Eigen matrices need no coordinates of their own: theirs are the entries.
template <class X>
concept EigenValued = std::derived_from<X, Eigen::MatrixBase<X>>;

}  // namespace detail

/// Base of every Lie groupoid: what is deduced from what the derived class writes.
///
/// The derived class **must** supply, for every scalar S:
///
///     template <class S> using Arrow = ...;    template <class S> using Object = ...;
///     Object<S> source(const Arrow<S>&)         Object<S> target(const Arrow<S>&)
///     Arrow<S>  unit(const Object<S>&)          Arrow<S>  inverse(const Arrow<S>&)
///     Arrow<S>  multiply(const Arrow<S>&, const Arrow<S>&)       product of composable arrows, unchecked
///     Arrow<S>  tau(const Object<S>& q, const Vector<S, dimension>& v)        the retraction, source(tau(q, v)) = q
///     Vector<S, dimension> tau_inverse(const Arrow<S>& g)        v with tau(source(g), v) = g, near the unit
///     static std::string name()
///
/// and, only when arrows (objects) are not Eigen matrices, `arrow_size`, `coordinates(g)`, `arrow<S>(coordinates)`
/// (`object_size`, `object_coordinates(q)`, `object<S>(coordinates)`).
/// It **may** supply `project(g)` (an arrow moved back onto G after round-off, identity by default) and, for speed,
/// `seed` (the translations in closed form), a frame of the whole arrow (arrow_frame.hpp), `extend`, `correct`,
/// `chart`, `arrow_in_chart` and `bracket` (algebroid.hpp); and `loop`, where paths can wind (loops.hpp). For its
/// geometry it supplies `displace_object` and `object_displacement` where its objects are not an open set of their
/// coordinates, and `bisection` where tau does not reach every arrow (see below). Everything else is deduced.
///
/// `Dimension` is the rank of AG: the dimension of the source fibres.
template <class Derived, int Dimension> class LieGroupoid {
 public:
  static constexpr int dimension = Dimension;

  /// The product g h. Requires beta(g) = alpha(h); checked builds throw NotComposable otherwise.
  template <class A> A compose(const A& g, const A& h) const {
    if constexpr (checked_build) require_composable(g, h);
    return self().multiply(g, h);
  }

  /// tau(a)^{-1} g tau(b): the arrow g with its source displaced by a in A_{alpha(g)}G and its target by b in
  /// A_{beta(g)}G.
  template <class A, class V> A translate(const V& a, const A& g, const V& b) const {
    const A moved = compose(self().inverse(self().tau(self().source(g), a)), g);
    return compose(moved, self().tau(self().target(g), b));
  }

  /// The arrow g as an arrow over the scalar S, a constant if S has derivatives.
  template <class S, class A> auto cast(const A& g) const {
    const auto x = coordinates_of_arrow(g);
    return arrow_at<S>(with_entries_of<Vector<S, arrow_coordinate_count()>>(x));
  }
  /// The object q as an object over the scalar S.
  template <class S, class Q> auto cast_object(const Q& q) const {
    const auto x = coordinates_of_object(q);
    return object_at<S>(with_entries_of<Vector<S, object_coordinate_count()>>(x));
  }

  /// The arrow tau(a)^{-1} g tau(b) over the scalar M, with infinitesimals for a and b: a function evaluated on it
  /// gives its derivatives with respect to displacements of the ends of g.
  ///
  /// M is a HyperDual, which has two sets of infinitesimals, left and right, or a Jet, where they are one set.
  /// Component i of the displacement of the end First is the left infinitesimal LeftOffset + i, that of the end Second
  /// the right infinitesimal RightOffset + i (both may be the same end). With n = dimension,
  ///
  ///     f(seed<HyperDual<double, n, n>, End::source, End::target>(g)).mixed()        d2f/dv dw at v = w = 0
  ///     f(seed<Jet<double, 2 * n>, End::source, End::target, 0, n>(g)).gradient()    (df/dv, df/dw)
  ///
  /// of (v, w) -> f(tau(v)^{-1} g tau(w)). `seed_by_composition` uses the operations of the groupoid alone. A groupoid
  /// that has its translations in closed form supplies a `seed` of this signature, which is faster; laws::groupoid_laws
  /// compares the two.
  template <class M, End First, End Second, int LeftOffset, int RightOffset, class A>
  auto seed_by_composition(const A& g) const {
    Vector<M, Dimension> a;
    for (int i = 0; i < Dimension; ++i) a(i) = M(0);
    Vector<M, Dimension> b = a;
    for (int i = 0; i < Dimension; ++i) {
      (First == End::source ? a : b)(i).set_left(LeftOffset + i, 1);
      (Second == End::source ? a : b)(i).set_right(RightOffset + i, 1);
    }
    return translate(a, cast<M>(g), b);
  }
  template <class M, End First, End Second, int LeftOffset = 0, int RightOffset = LeftOffset, class A>
  auto seed(const A& g) const {
    return seed_by_composition<M, First, Second, LeftOffset, RightOffset>(g);
  }

  /// g tau(w): the arrow with its target displaced by w. Derived by composition; a groupoid that has a cheaper formula
  /// supplies its own, equal to round-off.
  template <class A, class V> A extend(const A& g, const V& w) const {
    return compose(g, self().tau(self().target(g), w));
  }
  /// g <- g tau(w), projected, for a w of the size of round-off. Returns the part of w that was lost when the entries
  /// of g were rounded, so that the caller can add it to the next w; zero where entries are rounded up as often as
  /// down, as those of a rotation matrix are (the law "correcting an arrow" tests the sum of thousands of corrections).
  template <class A, class V> V correct(A& g, const V& w) const {
    const A by = self().tau(self().target(g), w);
    g = self().project(compose(g, by));
    return w - self().tau_inverse(by);
  }

  /// F+ - F-, the change of the momentum along g, from df/dv = -F- and df/dw = F+. On a group each determines the
  /// other, and g near the unit leaves little of them: such a groupoid supplies a form without cancellation.
  template <class A, class V> V momentum_change(const A&, const V& source_gradient, const V& target_gradient) const {
    return source_gradient + target_gradient;
  }

  /// Coordinates of the arrows near the unit in which a trajectory is extrapolated, and their inverse: tau unless the
  /// groupoid has a cheaper smooth chart of its source fibres.
  template <class A> auto chart(const A& g) const { return self().tau_inverse(g); }
  template <class Q, class V> auto arrow_in_chart(const Q& q, const V& v) const { return self().tau(q, v); }

  /// The local chart of the objects around q: the object at u, u in R^d, and its inverse; q itself at u = 0. By default
  /// u is added to the coordinates of q, right where these are an open set of R^d; other groupoids supply both, and
  /// `object_dimension` = d.
  template <class Q, class U> auto displace_object(const Q& q, const U& u) const {
    const auto x = coordinates_of_object(q);
    return object_at<typename decltype(x)::Scalar>((x + u).eval());
  }
  template <class Q> auto object_displacement(const Q& q, const Q& r) const {
    return (coordinates_of_object(r) - coordinates_of_object(q)).eval();
  }

  /// The arrow from q, near alpha(g), of a local bisection through g: alpha(b(q)) = q, b(alpha(g)) = g, beta o b a
  /// local diffeomorphism, smooth in g and q, and the units where g is one ([G] A.1). By default tau(q, tau^{-1}(g)).
  template <class A, class Q> A bisection(const A& g, const Q& q) const { return self().tau(q, self().tau_inverse(g)); }

  /// The left-invariant field X<-(g) = d/dt|0 g tau(t X) of X in A_{beta(g)}G, in arrow coordinates. [G] (1)
  template <class A, class V> auto left_invariant(const A& g, const V& x) const {
    using D = Dual<typename V::Scalar>;
    const auto gd = cast<D>(g);
    return derivative_of(coordinates_of_arrow(self().multiply(gd, self().tau(self().target(gd), infinitesimal(x)))));
  }

  /// The right-invariant field X->(g) = -d/dt|0 tau(t X)^{-1} g of X in A_{alpha(g)}G, in arrow coordinates. [G] (2)
  template <class A, class V> auto right_invariant(const A& g, const V& x) const {
    using D = Dual<typename V::Scalar>;
    const auto gd = cast<D>(g);
    const auto moved = self().multiply(self().inverse(self().tau(self().source(gd), infinitesimal(x))), gd);
    return (-derivative_of(coordinates_of_arrow(moved))).eval();
  }

  /// The anchor rho(X) = T beta(X) of X in A_qG, in object coordinates. [G] Def. 2.9
  template <class Q, class V> auto anchor(const Q& q, const V& x) const {
    using D = Dual<typename V::Scalar>;
    return derivative_of(coordinates_of_object(self().target(self().tau(cast_object<D>(q), infinitesimal(x)))));
  }

  /// The arrow g with a tangent vector in arrow coordinates, as an arrow over dual numbers.
  template <class A, class V> auto with_tangent(const A& g, const V& tangent) const {
    const auto x = coordinates_of_arrow(g);
    Vector<Dual<typename V::Scalar>, V::SizeAtCompileTime> xd;
    for (int i = 0; i < xd.size(); ++i) xd(i) = {x(i), tangent(i)};
    return arrow_at<Dual<typename V::Scalar>>(xd);
  }

  /// The arrow nearest to g that satisfies the groupoid's defining equations to round-off.
  template <class A> A project(const A& g) const { return g; }

  template <class A> auto coordinates_of_arrow(const A& g) const {
    if constexpr (detail::EigenValued<A>) {
      return with_entries_of<Vector<typename A::Scalar, A::SizeAtCompileTime>>(g);
    } else {
      return self().coordinates(g);
    }
  }
  template <class Q> auto coordinates_of_object(const Q& q) const {
    if constexpr (detail::EigenValued<Q>) {
      return with_entries_of<Vector<typename Q::Scalar, Q::SizeAtCompileTime>>(q);
    } else {
      return self().object_coordinates(q);
    }
  }
  template <class S, class V> auto arrow_at(const V& x) const {
    using A = typename Derived::template Arrow<S>;
    if constexpr (detail::EigenValued<A>) {
      return with_entries_of<A>(x);
    } else {
      return self().template arrow<S>(x);
    }
  }
  template <class S, class V> auto object_at(const V& x) const {
    using Q = typename Derived::template Object<S>;
    if constexpr (detail::EigenValued<Q>) {
      return with_entries_of<Q>(x);
    } else {
      return self().template object<S>(x);
    }
  }

  /// For each direction of the source fibre, the size of the coordinates that move along it: round-off in the arrow is
  /// this times the unit round-off. The largest coordinate by default; that of products is taken factor by factor.
  template <class A> auto coordinate_scale(const A& g) const {
    const auto x = coordinates_of_arrow(g);
    using S = typename decltype(x)::Scalar;
    using std::abs, std::max;
    S largest = abs(x(0));
    for (int i = 1; i < x.size(); ++i) largest = max(largest, S(abs(x(i))));
    Vector<S, Dimension> out;
    for (int i = 0; i < Dimension; ++i) out(i) = largest;
    return out;
  }

  /// Number of coordinates of an arrow (ambient: nine for a rotation matrix) and of an object.
  static constexpr int arrow_coordinate_count() {
    using A = typename Derived::template Arrow<double>;
    if constexpr (detail::EigenValued<A>) {
      return A::SizeAtCompileTime;
    } else {
      return Derived::arrow_size;
    }
  }
  static constexpr int object_coordinate_count() {
    using Q = typename Derived::template Object<double>;
    if constexpr (detail::EigenValued<Q>) {
      return Q::SizeAtCompileTime;
    } else {
      return Derived::object_size;
    }
  }

  /// How far the arrow ends from the object: the largest difference of coordinates, relative to the largest coordinate
  /// of the arrow's end where that is above one; of several side by side, that of the worst. NaN where a coordinate is
  /// not finite.
  template <class A, class Q> double end_gap(const A& g, const Q& q) const {
    const auto end = coordinates_of_object(self().target(g));
    const auto object = coordinates_of_object(q);
    double worst = 0;
    for (int lane = 0; lane < (end.size() == 0 ? 0 : lanes_in(value_of(end(0)))); ++lane) {
      double gap = 0;
      double size = 1;
      for (Eigen::Index i = 0; i < end.size(); ++i) {
        const double there = in_lane(value_of(end(i)), lane);
        const double difference = std::abs(there - in_lane(value_of(object(i)), lane));
        if (difference > gap || std::isnan(difference)) gap = difference;
        size = std::max(size, std::abs(there));
      }
      if (gap / size > worst || std::isnan(gap)) worst = gap / size;
    }
    return worst;
  }
  /// The `end_gap` that rounding may leave.
  static constexpr double largest_end_gap = 1e-9;

  /// Throws NotComposable unless beta(g) = alpha(h) up to `largest_end_gap`. Ends that are no numbers are let through:
  /// of these a status tells.
  template <class A> void require_composable(const A& g, const A& h) const {
    const double gap = end_gap(g, self().source(h));
    if (!(gap > largest_end_gap)) return;
    std::ostringstream message;
    message << Derived::name() << ": arrows do not compose: the first ends at ("
            << coordinates_of_object(self().target(g)).transpose() << "), the second starts at ("
            << coordinates_of_object(self().source(h)).transpose() << "), " << gap << " apart";
    throw NotComposable(message.str());
  }
  /// Throws std::invalid_argument where the initial arrow of a trajectory ends elsewhere than at its initial object.
  /// An arrow or object that is not finite is accepted here: the first step returns a status that reports it.
  template <class A, class Q> void require_initial_end(const A& configuration, const Q& object) const {
    if (const double gap = end_gap(configuration, object); gap > largest_end_gap)
      throw std::invalid_argument("configuration: the initial arrow ends " + std::to_string(gap) +
                                  " away from the initial object; it must end there");
  }

 private:
  const Derived& self() const { return static_cast<const Derived&>(*this); }
};

/// The dimension of Q.
template <class G> constexpr int object_dimension_of() {
  if constexpr (requires { G::object_dimension; }) {
    return G::object_dimension;
  } else {
    return G::object_coordinate_count();
  }
}

template <class G, class S = double> using ArrowOf = typename G::template Arrow<S>;
template <class G, class S = double> using ObjectOf = typename G::template Object<S>;
template <class G, class S = double> using AlgebroidVector = Vector<S, G::dimension>;

/// What every algorithm of Lagroid requires of a groupoid.
///
/// Invariants (checked by `core/testing/groupoid_laws.hpp`, not by the compiler): the groupoid axioms of [G] Def. 2.1;
/// tau(q, 0) = unit(q), source(tau(q, v)) = q, tau_inverse(tau(q, v)) = v for small v; all maps smooth there.
template <class G>
concept Groupoid = requires(const G& groupoid, const ArrowOf<G>& g, const ObjectOf<G>& q, const AlgebroidVector<G>& v) {
  { groupoid.source(g) } -> std::convertible_to<ObjectOf<G>>;
  { groupoid.target(g) } -> std::convertible_to<ObjectOf<G>>;
  { groupoid.unit(q) } -> std::convertible_to<ArrowOf<G>>;
  { groupoid.inverse(g) } -> std::convertible_to<ArrowOf<G>>;
  { groupoid.multiply(g, g) } -> std::convertible_to<ArrowOf<G>>;
  { groupoid.tau(q, v) } -> std::convertible_to<ArrowOf<G>>;
  { groupoid.tau_inverse(g) } -> std::convertible_to<AlgebroidVector<G>>;
  { groupoid.coordinates_of_arrow(g) } -> std::convertible_to<Vector<double, G::arrow_coordinate_count()>>;
  { groupoid.coordinates_of_object(q) } -> std::convertible_to<Vector<double, G::object_coordinate_count()>>;
  { G::name() } -> std::convertible_to<std::string>;
};

}  // namespace lagroid
