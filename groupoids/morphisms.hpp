#pragma once
/// The morphisms that come with the groupoids.

#include <lagroid/core/morphism.hpp>
#include <lagroid/groupoids/action.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/pair_of.hpp>
#include <lagroid/groupoids/product.hpp>

#include <cstddef>
#include <tuple>

namespace lagroid {

/// Pair(G) -> G, (a, b) -> a^{-1} b: reduction by left translations (Euler-Poincare, Lie-Poisson).
template <class Group> struct LeftQuotient : Morphism<LeftQuotient<Group>, PairOf<Group>, Group> {
  template <class E> E operator()(const ElementPair<E>& g) const { return this->from.quotient(g); }
  template <class E> ElementPair<E> lift(const E& a, const E& g) const { return {a, this->to.multiply(a, g)}; }
};

/// Pair(R^n) -> R^n, (q0, q1) -> q1 - q0: the same for translations.
template <int N> struct Difference : Morphism<Difference<N>, Pair<N>, VectorGroup<N>> {
  template <class S> Vector<S, N> operator()(const PairArrow<S, N>& g) const { return g.target - g.source; }
  template <class S> PairArrow<S, N> lift(const Vector<S, N>& q, const Vector<S, N>& g) const { return {q, q + g}; }
};

/// The action groupoid -> its group, (g, m) -> g.
template <class Group, class Space> struct Acting : Morphism<Acting<Group, Space>, Action<Group, Space>, Group> {
  template <class E, class P> E operator()(const ActionArrow<E, P>& g) const { return g.element; }
  template <class E, class P> ActionArrow<E, P> lift(const P& m, const E& g) const { return {g, m}; }
};

/// Pair(G) -> G acting on a space, (a, b) -> (a^{-1} b, m a): reduction by the left translations that leave m where it
/// is, as turning about the vertical m is for a heavy top.
template <class Group, class Space>
struct StabiliserQuotient : Morphism<StabiliserQuotient<Group, Space>, PairOf<Group>, Action<Group, Space>> {
  typename Space::template Point<double> fixed;

  explicit StabiliserQuotient(const typename Space::template Point<double>& m) : fixed(m) {}

  template <class E> auto operator()(const ElementPair<E>& g) const {
    using Point = typename Space::template Point<typename E::Scalar>;
    return ActionArrow<E, Point>{this->from.quotient(g),
                                 Space::act(Point(fixed.template cast<typename E::Scalar>()), g.source)};
  }
  template <class E, class P> ElementPair<E> lift(const E& a, const ActionArrow<E, P>& g) const {
    return {a, this->from.group.multiply(a, g.element)};
  }
};

/// The projection of a product to its factor I.
template <std::size_t I, class... Gs>
struct Projection : Morphism<Projection<I, Gs...>, Product<Gs...>, std::tuple_element_t<I, std::tuple<Gs...>>> {
  template <class... As> auto operator()(const std::tuple<As...>& g) const { return std::get<I>(g); }
};

/// The product of two morphisms.
template <class Phi, class Psi>
struct ProductMorphism : Morphism<ProductMorphism<Phi, Psi>, Product<typename Phi::Domain, typename Psi::Domain>,
                                  Product<typename Phi::Codomain, typename Psi::Codomain>> {
  [[no_unique_address]] Phi first;
  [[no_unique_address]] Psi second;
  template <class A, class B> auto operator()(const std::tuple<A, B>& g) const {
    return std::make_tuple(first(std::get<0>(g)), second(std::get<1>(g)));
  }
  template <class P, class Q, class A, class B> auto lift(const std::tuple<P, Q>& q, const std::tuple<A, B>& g) const {
    return std::make_tuple(first.lift(std::get<0>(q), std::get<0>(g)), second.lift(std::get<1>(q), std::get<1>(g)));
  }
};

/// G -> G, as a factor of a product of morphisms.
template <class G> struct IdentityMorphism : Morphism<IdentityMorphism<G>, G, G> {
  template <class A> A operator()(const A& g) const { return g; }
  template <class Q, class A> A lift(const Q&, const A& g) const { return g; }
};

}  // namespace lagroid
