#pragma once
/// Curves of arrows t -> tau(q, x(t)) in the chart of a retraction: the object where they are and their velocity in the
/// algebroid, g(t)^{-1} g'(t).
///
/// The action of a curve is the integral of l(object, velocity); in coordinates x any polynomial is such a curve.
///
///     const Pair<2> groupoid;
///     const Vector<double, 2> q(1, 0), x(0.1, 0.2), rate(1, 2);
///     const auto at = curve_point(groupoid, q, x, rate);  // at.object = q + x, at.velocity = rate
///
/// Requires x in the chart's domain. A groupoid may supply the velocity in closed form, for speed (`chart_velocity`);
/// else it is differentiated from tau. Nothing throws.
///
/// Source: Marrero, Martin de Diego, Stern, [G] 2 for retractions; Iserles, Munthe-Kaas, Norsett, Zanna, *Lie-group
/// methods*, Acta Numerica 9 (2000), for dtau.

#include <lagroid/core/groupoid.hpp>

#include <concepts>

namespace lagroid {

/// What is known of the curves t -> tau(q, t v); each holds of those after it too.
enum class RetractionKind {
  any,          ///< nothing
  symmetric,    ///< tau(q, v)^{-1} = tau(q', -v), and from there tau is exponential up to terms of third order
  exponential,  ///< they are motions of constant velocity
  translation   ///< and the chart's coordinates are those of an abelian group: x and y after one another make x + y
};

/// That of G, which declares `static constexpr RetractionKind retraction_kind` where something is known.
template <class G> constexpr RetractionKind retraction_kind_of() {
  if constexpr (requires {
                  { G::retraction_kind } -> std::convertible_to<RetractionKind>;
                }) {
    return G::retraction_kind;
  } else {
    return RetractionKind::any;
  }
}

/// A groupoid that has the velocity of its curves in closed form:
///
///     Vector<S, dimension> chart_velocity(const Object<S>& q, const Vector<S, dimension>& x,
///                                         const Vector<S, dimension>& rate)
///
/// g^{-1} dg/dt of g = tau(q, x(t)) at x with x' = rate.
template <class G>
concept HasChartVelocity = requires(const G& groupoid, const ObjectOf<G>& q, const AlgebroidVector<G>& x) {
  { groupoid.chart_velocity(q, x, x) } -> std::convertible_to<AlgebroidVector<G>>;
};

/// An object and a velocity over it: a point of AG.
template <class G, class S = double> struct CurvePoint {
  ObjectOf<G, S> object;
  AlgebroidVector<G, S> velocity;
};

/// The velocity by differentiation of tau: that of tau(q, x)^{-1} tau(q, x + t rate) at t = 0.
template <class S, Groupoid G>
AlgebroidVector<G, S> automatic_chart_velocity(const G& groupoid, const ObjectOf<G, S>& q,
                                               const AlgebroidVector<G, S>& x, const AlgebroidVector<G, S>& rate) {
  using D = Dual<S>;
  AlgebroidVector<G, D> moved;
  for (int i = 0; i < G::dimension; ++i) moved(i) = D(x(i), rate(i));
  const auto back = groupoid.template cast<D>(groupoid.inverse(groupoid.tau(q, x)));
  const auto by = groupoid.multiply(back, groupoid.tau(groupoid.template cast_object<D>(q), moved));
  const AlgebroidVector<G, D> v = groupoid.tau_inverse(by);
  return derivative_of(v);
}

/// The velocity where the curve tau(q, x(t)) is, from x and x' = rate.
template <class S, Groupoid G>
AlgebroidVector<G, S> velocity_in_chart(const G& groupoid, const ObjectOf<G, S>& q, const AlgebroidVector<G, S>& x,
                                        const AlgebroidVector<G, S>& rate) {
  if constexpr (HasChartVelocity<G>) {
    return groupoid.chart_velocity(q, x, rate);
  } else {
    return automatic_chart_velocity<S>(groupoid, q, x, rate);
  }
}

/// The same as a point of AG.
template <class S, Groupoid G>
CurvePoint<G, S> curve_point(const G& groupoid, const ObjectOf<G, S>& q, const AlgebroidVector<G, S>& x,
                             const AlgebroidVector<G, S>& rate) {
  CurvePoint<G, S> out;
  if constexpr (object_dimension_of<G>() > 0) out.object = groupoid.target(groupoid.tau(q, x));
  out.velocity = velocity_in_chart<S>(groupoid, q, x, rate);
  return out;
}

}  // namespace lagroid
