#pragma once
/// The action groupoid of a Lie group G that acts on a space M from the right: arrows (g, m) from m to m g, with (g,
/// m)(h, m g) = (g h, m).
///
/// A potential takes symmetry from a group: that of a heavy top depends on the vertical as the body sees it. The
/// objects of this groupoid are what the potential depends on, its arrows still the elements of the group.
///
///     const Action<SO3, RotatedDirections> groupoid{};  // m g = g^T m
///     const auto g = groupoid.tau(Vector<double, 3>(0, 0, 1), Vector<double, 3>(0.1, 0, 0));
///     const Vector<double, 3> vertical = groupoid.target(g);  // seen from the body after a turn by 0.1
///
/// Requires a group that is a groupoid of ours over a single object, and a space with (m g) h = m (g h). Returns arrows
/// {element, point}. Errors are those of the group.

#include <lagroid/core/algebroid.hpp>
#include <lagroid/core/capabilities/loops.hpp>
#include <lagroid/core/continuous/curve_point.hpp>
#include <lagroid/core/derivatives/directional.hpp>

#include <algorithm>
#include <string>

namespace lagroid {

/// An arrow of Action: a group element and the point it starts from.
template <class Element, class Point> struct ActionArrow {
  Element element;
  Point point;
};

/// Arrows (g, m) from m to m g; (g, m)(h, m g) = (g h, m). Algebroid: the Lie algebra at every point, with its bracket
/// for constant sections; the anchor is the infinitesimal action. Retraction tau_m(v) = (tau(v), m). (g, m) -> g is a
/// morphism to the group. Memory: the group element, then the point.
///
/// `Group` is a groupoid of ours over a single object. `Space` supplies
///
///     template <class S> using Point = Vector<S, ...>;
///     static Point<S> act(const Point<S>& m, const Group::Arrow<S>& g)        m g, with (m g) h = m (g h)
///     static std::string name()
///
/// and, where points are not an open set of their coordinates, a chart: `dimension`, `displace(m, u)`,
/// `displacement(m, r)` (see LieGroupoid::displace_object) and `project(m)`.
template <class Group, class Space> struct Action : LieGroupoid<Action<Group, Space>, Group::dimension> {
  static constexpr int rank = Group::dimension;
  template <class S> using Element = typename Group::template Arrow<S>;
  template <class S> using Object = typename Space::template Point<S>;
  template <class S> using Arrow = ActionArrow<Element<S>, Object<S>>;
  static constexpr int object_size = Object<double>::SizeAtCompileTime;
  static constexpr int element_size = Group::arrow_coordinate_count();
  static constexpr int arrow_size = element_size + object_size;
  static constexpr int object_dimension = [] {
    if constexpr (requires { Space::dimension; }) {
      return Space::dimension;
    } else {
      return object_size;
    }
  }();

  [[no_unique_address]] Group group;

  template <class E, class S> static Vector<S, object_size> source(const ActionArrow<E, Vector<S, object_size>>& g) {
    return g.point;
  }
  template <class E, class S> static Vector<S, object_size> target(const ActionArrow<E, Vector<S, object_size>>& g) {
    return Space::act(g.point, g.element);
  }
  template <class S> Arrow<S> unit(const Vector<S, object_size>& m) const { return {group.unit(Vector<S, 0>()), m}; }
  template <class E, class P> ActionArrow<E, P> inverse(const ActionArrow<E, P>& g) const {
    return {group.inverse(g.element), target(g)};
  }
  template <class E, class P> ActionArrow<E, P> multiply(const ActionArrow<E, P>& g, const ActionArrow<E, P>& h) const {
    return {group.multiply(g.element, h.element), g.point};
  }
  template <class S> Arrow<S> tau(const Vector<S, object_size>& m, const Vector<S, rank>& v) const {
    return {group.tau(Vector<S, 0>(), v), m};
  }
  template <class E, class P> auto tau_inverse(const ActionArrow<E, P>& g) const {
    return group.tau_inverse(g.element);
  }

  template <class S>
  Vector<S, rank> bracket(const Vector<S, object_size>&, const Vector<S, rank>& x,
                          const Vector<S, rank>& y) const requires HasAnalyticBracket<Group> {
    return group.bracket(Vector<S, 0>(), x, y);
  }
  /// The velocity is that of the group's curve.
  static constexpr RetractionKind retraction_kind = std::min(retraction_kind_of<Group>(), RetractionKind::exponential);
  template <class S>
  Vector<S, rank> chart_velocity(const Vector<S, object_size>&, const Vector<S, rank>& x,
                                 const Vector<S, rank>& rate) const requires HasChartVelocity<Group> {
    return group.chart_velocity(Vector<S, 0>(), x, rate);
  }
  template <class E, class P> ActionArrow<E, P> bisection(const ActionArrow<E, P>& g, const P& m) const {
    return {g.element, m};
  }
  /// Those of the group: on the way from m back to m.
  static constexpr int loops = loops_of<Group>();
  Arrow<double> loop(const Object<double>& m, const Vector<double, rank>& axis,
                     const Vector<double, loops>& turns) const requires(loops > 0) {
    return {group.loop(Vector<double, 0>(), axis, turns), m};
  }
  template <class P, class U> P displace_object(const P& m, const U& u) const {
    if constexpr (requires { Space::dimension; }) {
      return Space::displace(m, u);
    } else {
      return m + u;
    }
  }
  template <class S>
  Vector<S, object_dimension> object_displacement(const Vector<S, object_size>& m,
                                                  const Vector<S, object_size>& r) const {
    if constexpr (requires { Space::dimension; }) {
      return Space::displacement(m, r);
    } else {
      return r - m;
    }
  }

  template <class E, class P> ActionArrow<E, P> project(const ActionArrow<E, P>& g) const {
    if constexpr (requires { Space::project(g.point); }) {
      return {group.project(g.element), Space::project(g.point)};
    } else {
      return {group.project(g.element), g.point};
    }
  }
  template <class E, class P, class V> ActionArrow<E, P> extend(const ActionArrow<E, P>& g, const V& w) const {
    return {group.extend(g.element, w), g.point};
  }
  template <class E, class P, class V> V correct(ActionArrow<E, P>& g, const V& w) const {
    return group.correct(g.element, w);
  }
  template <class E, class P> auto chart(const ActionArrow<E, P>& g) const { return group.chart(g.element); }
  template <class S, class V> Arrow<S> arrow_in_chart(const Vector<S, object_size>& m, const V& v) const {
    return {group.arrow_in_chart(Vector<S, 0>(), v), m};
  }
  template <class E, class P> auto coordinate_scale(const ActionArrow<E, P>& g) const {
    return group.coordinate_scale(g.element);
  }

  template <class E, class S> Vector<S, arrow_size> coordinates(const ActionArrow<E, Vector<S, object_size>>& g) const {
    return joined<S, element_size, object_size>(group.coordinates_of_arrow(g.element), g.point);
  }
  template <class S, class V> Arrow<S> arrow(const V& x) const {
    const Vector<S, arrow_size> numbers = x;
    return {group.template arrow_at<S>(part<0, element_size>(numbers)), part<element_size, object_size>(numbers)};
  }

  static std::string name() { return Group::name() + " on " + Space::name(); }
};

}  // namespace lagroid
