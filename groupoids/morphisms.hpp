#pragma once
/// The morphisms that come with the groupoids.

#include <lagroid/core/morphism.hpp>
#include <lagroid/groupoids/action.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/pair_of.hpp>
#include <lagroid/groupoids/product.hpp>

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace lagroid {

/// Pair(G) -> G, (a, b) -> a^{-1} b: reduction by left translations (Euler-Poincare, Lie-Poisson). G is any groupoid of
/// ours over a single object: a group, a product of groups, a user's own. The arrow (e, g) stands for g.
template <class Group> struct LeftQuotient : Morphism<LeftQuotient<Group>, PairOf<Group>, Group> {
  static constexpr bool keeps_basis = true;
  template <class E> StepFromUnit<E> representative(const E& g) const {
    using S = typename decltype(this->to.coordinates_of_arrow(g))::Scalar;
    return {this->to.unit(ObjectOf<Group, S>()), g};
  }
  template <class E> E operator()(const ElementPair<E>& g) const { return this->from.quotient(g); }
  template <class E> ElementPair<E> lift(const E& a, const E& g) const { return {a, this->to.multiply(a, g)}; }
};

/// Pair(R^n) -> R^n, (q0, q1) -> q1 - q0: the same for translations.
template <int N> struct Difference : Morphism<Difference<N>, Pair<N>, VectorGroup<N>> {
  static constexpr bool keeps_basis = true;
  template <class S> PairArrow<S, N> representative(const Vector<S, N>& g) const {
    return {Vector<S, N>::Constant(S(0.0)), g};
  }
  template <class S> Vector<S, N> operator()(const PairArrow<S, N>& g) const { return g.target - g.source; }
  template <class S> PairArrow<S, N> lift(const Vector<S, N>& q, const Vector<S, N>& g) const { return {q, q + g}; }
};

/// The action groupoid -> its group, (g, m) -> g.
template <class Group, class Space> struct Acting : Morphism<Acting<Group, Space>, Action<Group, Space>, Group> {
  static constexpr bool keeps_basis = true;
  template <class E, class P> E operator()(const ActionArrow<E, P>& g) const { return g.element; }
  template <class E, class P> ActionArrow<E, P> lift(const P& m, const E& g) const { return {g, m}; }
};

/// Pair(G) -> G acting on a space, (a, b) -> (a^{-1} b, m a): reduction by the left translations that leave m where it
/// is, as turning about the vertical m is for a heavy top. For reduction downward the space says which element takes m
/// to a point, `carrying(m, v)`, smooth near each v; it may jump.
template <class Group, class Space>
struct StabiliserQuotient : Morphism<StabiliserQuotient<Group, Space>, PairOf<Group>, Action<Group, Space>> {
  static constexpr bool keeps_basis = true;
  typename Space::template Point<double> fixed;

  explicit StabiliserQuotient(const typename Space::template Point<double>& m) : fixed(m) {}

  template <class P> auto over(const P& v) const requires requires { Space::carrying(fixed, v); }
  { return Space::carrying(fixed, v); }
  template <class E, class P> auto representative(const ActionArrow<E, P>& g) const requires requires {
    Space::carrying(fixed, g.point);
  }
  {
    const E a = over(g.point);
    return ElementStep<E>{{a, this->from.group.multiply(a, g.element)}, g.element};
  }

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

/// The product of morphisms, of a product to a product.
template <class... Phis>
struct ProductMorphism
    : Morphism<ProductMorphism<Phis...>, Product<typename Phis::Domain...>, Product<typename Phis::Codomain...>> {
  static constexpr bool keeps_basis = (Phis::keeps_basis && ...);
  [[no_unique_address]] std::tuple<Phis...> factor;

  template <class... As> auto operator()(const std::tuple<As...>& g) const {
    return each([](const auto& phi, const auto& gi) { return phi(gi); }, g);
  }
  template <class... Qs, class... As> auto lift(const std::tuple<Qs...>& q, const std::tuple<As...>& g) const {
    return each([](const auto& phi, const auto& qi, const auto& gi) { return phi.lift(qi, gi); }, q, g);
  }
  template <class... As> auto representative(const std::tuple<As...>& g) const requires(RepresentsArrows<Phis>&&...) {
    return each([](const auto& phi, const auto& gi) { return representative_of(phi, gi); }, g);
  }
  template <class... Qs> bool free_at(const std::tuple<Qs...>& m) const requires(FreeInPart<Phis> || ...) {
    return std::apply([](const auto&... free) { return (free && ...); },
                      each(
                          [](const auto& phi, const auto& mi) {
                            if constexpr (requires { phi.free_at(mi); }) {
                              return phi.free_at(mi);
                            } else {
                              return true;
                            }
                          },
                          m));
  }

 private:
  /// f at each factor and at the parts of the tuples that belong to it.
  template <class F, class... Tuples> auto each(const F& f, const Tuples&... tuples) const {
    const auto at = [&]<std::size_t I>(std::integral_constant<std::size_t, I>) {
      return f(std::get<I>(factor), std::get<I>(tuples)...);
    };
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      return std::make_tuple(at(std::integral_constant<std::size_t, I>{})...);
    }
    (std::index_sequence_for<Phis...>{});
  }
};

/// G -> G, as a factor of a product of morphisms.
template <class G> struct IdentityMorphism : Morphism<IdentityMorphism<G>, G, G> {
  static constexpr bool keeps_basis = true;
  template <class Q> Q over(const Q& q) const { return q; }
  template <class A> A representative(const A& g) const { return g; }
  template <class A> A operator()(const A& g) const { return g; }
  template <class Q, class A> A lift(const Q&, const A& g) const { return g; }
};

}  // namespace lagroid
