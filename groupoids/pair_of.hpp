#pragma once
/// The pair groupoid G x G => G of a Lie group: a groupoid of ours over a single object, a user's included.

#include <lagroid/core/algebroid.hpp>
#include <lagroid/core/capabilities/loops.hpp>
#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/groupoids/pair.hpp>

#include <string>

namespace lagroid {

/// An arrow from one group element to another.
template <class Element> struct ElementPair {
  Element source;
  Element target;
};

/// Such an arrow that knows a^{-1} b, for systems on pairs that are reduced: Lagrangians that ask the groupoid for
/// `quotient` then cost no product of elements.
template <class Element> struct ElementStep : ElementPair<Element> { Element quotient; };
/// One from the unit, whose target that is: what stands for an element of the group (LeftQuotient). It looks at the
/// element, which must outlive it: g++ makes the copy of a target that nobody reads, a tenth of a free body's step.
template <class Element> struct StepFromUnit {
  Element source;
  const Element& target;
  operator ElementPair<Element>() const { return {source, target}; }
};

/// Arrows: pairs (a, b) of elements of `Group`; (a, b)(b, c) = (a, c). Algebroid: TG, left-trivialised, so that
/// constant sections are the group's left-invariant fields; anchor x -> a hat(x). Retraction tau_a(v) = (a, a tau(v)).
/// Memory: source, then target.
template <class Group> struct PairOf : LieGroupoid<PairOf<Group>, Group::dimension> {
  static constexpr int rank = Group::dimension;
  static constexpr int object_dimension = rank;
  template <class S> using Object = typename Group::template Arrow<S>;
  template <class S> using Arrow = ElementPair<Object<S>>;
  static constexpr int half = Group::arrow_coordinate_count();
  static constexpr int arrow_size = 2 * half;
  static constexpr int object_size = Group::arrow_coordinate_count();
  /// The group's single object.
  template <class S> using Point = typename Group::template Object<S>;

  [[no_unique_address]] Group group;

  template <class E> static E source(const ElementPair<E>& g) { return g.source; }
  template <class E> static E target(const ElementPair<E>& g) { return g.target; }
  template <class E> static ElementPair<E> unit(const E& a) { return {a, a}; }
  template <class E> static ElementPair<E> inverse(const ElementPair<E>& g) { return {g.target, g.source}; }
  template <class E> static ElementPair<E> multiply(const ElementPair<E>& g, const ElementPair<E>& h) {
    return {g.source, h.target};
  }
  template <class E, class S> ElementPair<E> tau(const E& a, const Vector<S, rank>& v) const {
    return {a, displace_object(a, v)};
  }
  template <class E> auto tau_inverse(const ElementPair<E>& g) const { return object_displacement(g.source, g.target); }
  template <class E, class S>
  auto bracket(const E&, const Vector<S, rank>& x, const Vector<S, rank>& y) const requires HasAnalyticBracket<Group> {
    return group.bracket(Point<S>(), x, y);
  }
  /// Those of the group, from a back to a.
  static constexpr int loops = loops_of<Group>();
  Arrow<double> loop(const Object<double>& a, const Vector<double, rank>& axis,
                     const Vector<double, loops>& turns) const requires(loops > 0) {
    return {a, group.multiply(a, group.loop(Point<double>(), axis, turns))};
  }
  /// Translation from the left.
  template <class E> ElementPair<E> bisection(const ElementPair<E>& g, const E& a) const {
    return {a, group.multiply(a, quotient(g))};
  }
  template <class E, class S> E displace_object(const E& a, const Vector<S, rank>& v) const {
    return group.multiply(a, group.tau(Point<S>(), v));
  }
  template <class E> auto object_displacement(const E& a, const E& b) const {
    return group.tau_inverse(quotient(ElementPair<E>{a, b}));
  }
  template <class E> ElementPair<E> project(const ElementPair<E>& g) const {
    return {group.project(g.source), group.project(g.target)};
  }
  template <class E, class V> ElementPair<E> extend(const ElementPair<E>& g, const V& w) const {
    return {g.source, group.extend(g.target, w)};
  }
  template <class E, class V> V correct(ElementPair<E>& g, const V& w) const { return group.correct(g.target, w); }
  template <class E> auto chart(const ElementPair<E>& g) const { return group.chart(quotient(g)); }

  /// a^{-1} b, the morphism to the group.
  template <class E> E quotient(const ElementPair<E>& g) const {
    return group.multiply(group.inverse(g.source), g.target);
  }
  template <class E> static const E& quotient(const ElementStep<E>& g) { return g.quotient; }

  // What a Lagrangian may ask of the step that stands for its own quotient.
  template <class E> static const E& quotient(const StepFromUnit<E>& g) { return g.target; }
  template <class E> static E source(const StepFromUnit<E>& g) { return g.source; }
  template <class E> static E target(const StepFromUnit<E>& g) { return g.target; }
  template <class E> auto tau_inverse(const StepFromUnit<E>& g) const { return group.tau_inverse(g.target); }
  template <class E> auto chart(const StepFromUnit<E>& g) const { return group.chart(g.target); }
  template <class E> ElementPair<E> inverse(const StepFromUnit<E>& g) const { return {g.target, g.source}; }

  template <class E, class V> ElementPair<E> arrow_in_chart(const E& a, const V& v) const {
    return {a, group.multiply(a, group.arrow_in_chart(Point<typename V::Scalar>(), v))};
  }

  template <class E> auto coordinates(const ElementPair<E>& g) const {
    const auto a = group.coordinates_of_arrow(g.source);
    using S = typename decltype(a)::Scalar;
    return joined<S, half, half>(a, group.coordinates_of_arrow(g.target));
  }
  template <class S, class V> Arrow<S> arrow(const V& x) const {
    const Vector<S, arrow_size> numbers = x;
    return {group.template arrow_at<S>(part<0, half>(numbers)), group.template arrow_at<S>(part<half, half>(numbers))};
  }

  template <class E> auto object_coordinates(const E& a) const { return group.coordinates_of_arrow(a); }
  template <class S, class V> Object<S> object(const V& x) const { return group.template arrow_at<S>(x); }

  static std::string name() { return "Pair(" + Group::name() + ")"; }
};

}  // namespace lagroid
