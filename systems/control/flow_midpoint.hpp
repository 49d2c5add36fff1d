#pragma once
/// Where an arrow is half way: the object beta(tau(alpha(g), v / 2)), v = tau^{-1}(g), factor by factor of a product,
/// of those factors that are read.
///
///     const auto q = detail::moved_target<Reads>(groupoid, g, half);  // Reads::reads(i) of each factor
///
/// Nothing throws.

#include <lagroid/groupoids/product.hpp>

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace lagroid {

/// In place of an object that a flow does not read (`flow_reads`).
struct Unread {};

namespace detail {

/// beta(tau(q, v)) of one factor. A group has but one object, and evaluates no retraction.
template <class G, class Q, class S>
auto moved_object(const G& groupoid, const Q& q, const Vector<S, G::dimension>& v) {
  if constexpr (G::object_coordinate_count() == 0) {
    return q;
  } else {
    return groupoid.target(groupoid.tau(q, v));
  }
}

/// The same, of those factors of a product that are read.
template <class Read, class G, class S, class A>
auto moved_target(const G& groupoid, const A& g, const Vector<S, G::dimension>& v) {
  return moved_object(groupoid, groupoid.source(g), v);
}
template <class Read, class... Gs, class S, class A>
auto moved_target(const Product<Gs...>& groupoid, const A& g, const Vector<S, Product<Gs...>::dimension>& v) {
  int at = 0;
  const auto moved = [&]<std::size_t I>(std::integral_constant<std::size_t, I>) {
    const auto& factor = std::get<I>(groupoid.factor);
    using F = std::remove_cvref_t<decltype(factor)>;
    const int begin = std::exchange(at, at + F::dimension);
    if constexpr (Read::reads(I)) {
      Vector<S, F::dimension> part;
      for (int i = 0; i < F::dimension; ++i) part(i) = v(begin + i);
      return moved_object(factor, factor.source(std::get<I>(g)), part);
    } else {
      return Unread{};
    }
  };
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return std::tuple{moved(std::integral_constant<std::size_t, I>())...};  // braces: in their order
  }
  (std::index_sequence_for<Gs...>());
}

}  // namespace detail

}  // namespace lagroid
