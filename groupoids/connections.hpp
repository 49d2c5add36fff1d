#pragma once
/// Discrete connections of gauge groupoids with an Abelian group: which part of an arrow is motion of the base, and
/// which is motion along the fibres.
///
///     g  <->  (b, theta),    b = connection(g) an arrow of the base groupoid, theta = connection.angle(g) in R^k
///
/// A connection is a Morphism from the gauge (Atiyah) groupoid to that of the base which also supplies
///
///     static constexpr int angles                        k, the dimension of the group
///     static constexpr bool flat                         whether angle(g h) = angle(g) + angle(h)
///     Vector<S, k> angle(const Arrow& g) const           near 0 at units; angle(k g) = angle(k) + angle(g)
///     Arrow attach(const Arrow'& b, const Vector<S, k>& theta) const          the arrow with both; attach(b, 0) is
///                                                                             the horizontal lift of b
///
/// and may supply, for speed,
///
///     Matrix adapted_basis(const Object'& m) const          the horizontal lifts of the basis at m, then the angles'
///                                                           directions, as columns
///
/// (Leok, Marsden & Weinstein, A Discrete Theory of Connections on Principal Bundles, arXiv:math/0508338.) Where the
/// horizontal arrows are closed under products the connection is flat; where they are not, its curvature acts as a
/// magnetic field on a system of fixed momentum (core/reduction/momentum_level.hpp) and is what a geometric phase adds
/// up (core/reduction/phase.hpp).

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/morphism.hpp>
#include <lagroid/groupoids/pair_of_points.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/groupoids/rotated.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace lagroid {

/// Numbers of factors of a product.
template <std::size_t... I> using Factors = std::index_sequence<I...>;

namespace detail {

/// The product of some factors: of one, that one itself.
template <class Numbers, class... Gs> struct ProductOfSome;
template <std::size_t... I, class... Gs> struct ProductOfSome<Factors<I...>, Gs...> {
  using type = Product<std::tuple_element_t<I, std::tuple<Gs...>>...>;
};
template <std::size_t I, class... Gs> struct ProductOfSome<Factors<I>, Gs...> {
  using type = std::tuple_element_t<I, std::tuple<Gs...>>;
};

/// The numbers below Count that are not among I..., in order.
template <std::size_t Count, std::size_t... I> constexpr auto other_numbers(Factors<I...>) {
  constexpr auto others = [] {
    std::array<std::size_t, Count - sizeof...(I)> out{};
    std::size_t next = 0;
    for (std::size_t j = 0; j < Count; ++j)
      if (((j != I) && ...)) out[next++] = j;
    return out;
  }();
  return [&]<std::size_t... J>(std::index_sequence<J...>) { return Factors<others[J]...>{}; }
  (std::make_index_sequence<others.size()>{});
}
template <std::size_t Count, class Numbers> using OtherNumbers = decltype(other_numbers<Count>(Numbers{}));

/// Where J stands in the list.
template <std::size_t J, std::size_t... I> constexpr std::size_t position(Factors<I...>) {
  std::size_t at = 0;
  std::size_t found = sizeof...(I);
  ((I == J ? void(found = at++) : void(++at)), ...);
  return found;
}

}  // namespace detail

/// The flat connection of a product with Abelian groups, those of its factors that are named: the rotor angles of a
/// satellite, the polar angle of a planar motion. theta = tau^{-1} of the groups' elements.
///
///     FactorConnection<Factors<1>, Pair<1>, SO2>              FactorConnection<Factors<1, 2, 3>, SO3, SO2, SO2, SO2>
template <class Fibre, class... Gs>
struct FactorConnection
    : Morphism<FactorConnection<Fibre, Gs...>, Product<Gs...>,
               typename detail::ProductOfSome<detail::OtherNumbers<sizeof...(Gs), Fibre>, Gs...>::type> {
  using Base = detail::OtherNumbers<sizeof...(Gs), Fibre>;
  template <std::size_t I> using Factor = std::tuple_element_t<I, std::tuple<Gs...>>;
  static constexpr int angles = []<std::size_t... I>(Factors<I...>) { return (Factor<I>::dimension + ...); }
  (Fibre{});
  static constexpr bool flat = true;
  static constexpr int rank = Product<Gs...>::dimension;

  template <class... As> auto operator()(const std::tuple<As...>& g) const {
    return [&]<std::size_t... I>(Factors<I...>) {
      if constexpr (sizeof...(I) == 1) {
        return std::get<I...>(g);
      } else {
        return std::tuple(std::get<I>(g)...);
      }
    }
    (Base{});
  }
  template <class... As> auto angle(const std::tuple<As...>& g) const {
    using S = typename decltype(this->from.coordinates_of_arrow(g))::Scalar;
    Vector<S, angles> theta;
    [&]<std::size_t... I>(Factors<I...>) {
      (
          [&] {
            const Vector<S, Factor<I>::dimension> of_factor = factor<I>().tau_inverse(std::get<I>(g));
            for (int i = 0; i < Factor<I>::dimension; ++i) theta(offset<I> + i) = of_factor(i);
          }(),
          ...);
    }
    (Fibre{});
    return theta;
  }
  template <class B, class S> ArrowOf<Product<Gs...>, S> attach(const B& b, const Vector<S, angles>& theta) const {
    const auto element = [&]<std::size_t J>(std::integral_constant<std::size_t, J>) {
      if constexpr (constexpr auto at = detail::position<J>(Base{}); at == Base::size()) {
        return factor<J>().tau(Vector<S, 0>(), part<offset<J>, Factor<J>::dimension>(theta));
      } else if constexpr (Base::size() == 1) {
        return b;
      } else {
        return std::get<at>(b);
      }
    };
    return [&]<std::size_t... J>(std::index_sequence<J...>)->ArrowOf<Product<Gs...>, S> {
      return {element(std::integral_constant<std::size_t, J>{})...};
    }
    (std::index_sequence_for<Gs...>{});
  }
  /// The bases of the factors, those of the base first.
  template <class Q> Matrix<double, rank, rank> adapted_basis(const Q&) const {
    Matrix<double, rank, rank> basis;
    for (int i = 0; i < rank * rank; ++i) basis(i) = 0;
    int column = 0;
    const auto append = [&]<std::size_t... I>(Factors<I...>) {
      (
          [&] {
            for (int i = 0; i < Factor<I>::dimension; ++i) basis(start<I> + i, column++) = 1;
          }(),
          ...);
    };
    append(Base{});
    append(Fibre{});
    return basis;
  }

 private:
  /// Where the directions of factor J begin in those of the product.
  template <std::size_t J> static constexpr int start = []<std::size_t... I>(Factors<I...>) {
    return ((I < J ? Gs::dimension : 0) + ...);
  }
  (std::index_sequence_for<Gs...>{});
  template <std::size_t I> const Factor<I>& factor() const { return std::get<I>(this->from.factor); }
  /// Where the angles of factor J begin.
  template <std::size_t J> static constexpr int offset = []<std::size_t... I>(Factors<I...>) {
    return ((I < J ? Factor<I>::dimension : 0) + ...);
  }
  (Fibre{});
};

/// That of SO(3) over the sphere of directions, on its gauge groupoid under rotations about a direction fixed in space
/// (StabiliserQuotient): the horizontal arrows are the shortest rotations from one direction to the next, so that along
/// them bodies are carried parallel on the sphere. Its curvature is that of the sphere, theta in (-pi, pi]. Not where
/// two directions are opposite.
struct ShortestRotation : Morphism<ShortestRotation, Action<SO3, RotatedDirections>, PairOfPoints<RotatedDirections>> {
  static constexpr int angles = 1;
  static constexpr bool flat = false;

  template <class S> PairArrow<S, 3> operator()(const ActionArrow<Matrix<S, 3, 3>, Vector<S, 3>>& g) const {
    return {g.point, RotatedDirections::act(g.point, g.element)};
  }
  template <class S> Vector<S, 1> angle(const ActionArrow<Matrix<S, 3, 3>, Vector<S, 3>>& g) const {
    using std::atan2;
    const Matrix<S, 3, 3> about = g.element * shortest((*this)(g)).transpose();
    return Vector<S, 1>(atan2(SO3::vee(about).dot(g.point), (about.trace() - 1.0) * 0.5));
  }
  template <class S>
  ActionArrow<Matrix<S, 3, 3>, Vector<S, 3>> attach(const PairArrow<S, 3>& b, const Vector<S, 1>& theta) const {
    return {SO3::exp(Vector<S, 3>(b.source * theta(0))) * shortest(b), b.source};
  }

 private:
  /// R with R m1 = m0: I + hat(c) + hat(c)^2 / (1 + m0.m1), c = m1 x m0.
  template <class S> static Matrix<S, 3, 3> shortest(const PairArrow<S, 3>& b) {
    const Vector<S, 3> c = b.target.cross(b.source);
    const Matrix<S, 3, 3> hat = SO3::hat(c);
    const Matrix<S, 3, 3> one = Matrix<S, 3, 3>::Identity();
    return one + hat + hat * hat / S(b.source.dot(b.target) + 1.0);
  }
};

}  // namespace lagroid
