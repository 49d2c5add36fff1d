#pragma once
/// An arrow with both ends displaced, over scalars with derivatives along both,
///
///     tau(a)^{-1} g tau(b),    a_i and b_i the infinitesimals Source + i and Target + i of J,
///
/// each factor of a product over jets of its own directions alone: what a factor is made of does not depend on the
/// others, and the cost of a second-order jet grows with the square of its directions.
///
///     using J = SecondJet<double, 2 * n>;
///     const ArrowOf<G, J> g = displaced_jet<J>(groupoid, arrow, 0, n);
///     const Vector<double, 2 * n> slope = function(g).gradient();  // along the source, then along the target
///
/// Requires a Jet or SecondJet J of directions enough. Nothing throws.

#include <lagroid/core/groupoid.hpp>
#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/core/scalars/second_jet.hpp>
#include <lagroid/groupoids/product.hpp>

#include <tuple>
#include <utility>

namespace lagroid {

namespace detail {

/// J with another number of directions.
template <class J, int Count> struct WithDirections;
template <class T, int N, int Count> struct WithDirections<Jet<T, N>, Count> { using Type = Jet<T, Count>; };
template <class T, int N, int Count> struct WithDirections<SecondJet<T, N>, Count> {
  using Type = SecondJet<T, Count>;
};

/// x with its first n directions in the places from `source` on, and its last n in those from `target` on.
template <class J, int n, class Few> J with_directions_at(const Few& x, int source, int target) {
  const auto widened = [&](const auto& few) {
    auto out = J::along(0, 0.0);
    for (int i = 0; i < n; ++i) {
      out.set(source + i, few(i));
      out.set(target + i, few(n + i));
    }
    return out;
  };
  J out(x.value, widened([&](int i) { return x.gradient(i); }));
  if constexpr (requires { x.hessian(0, 0); })
    for (int half = 0; half < 2; ++half)
      for (int i = 0; i < n; ++i)
        out.set_row((half == 0 ? source : target) + i,
                    widened([&, row = half * n + i](int j) { return x.hessian(row, j); }));
  return out;
}

}  // namespace detail

template <class J, class G> auto displaced_jet(const G& groupoid, const ArrowOf<G>& g, int source, int target) {
  constexpr int n = G::dimension;
  using Few = typename detail::WithDirections<J, 2 * n>::Type;
  Vector<Few, n> a;
  Vector<Few, n> b;
  for (int i = 0; i < n; ++i) {
    a(i) = Few::variable(0, i);
    b(i) = Few::variable(0, n + i);
  }
  const auto few = groupoid.coordinates_of_arrow(groupoid.translate(a, groupoid.template cast<Few>(g), b));
  Vector<J, G::arrow_coordinate_count()> x;
  for (int i = 0; i < x.size(); ++i) x(i) = detail::with_directions_at<J, n>(few(i), source, target);
  return groupoid.template arrow_at<J>(x);
}
template <class J, class... Gs>
auto displaced_jet(const Product<Gs...>& groupoid, const ArrowOf<Product<Gs...>>& g, int source, int target) {
  int at = 0;
  const auto displaced = [&]<class F, class A>(const F& factor, const A& arrow) {
    const int begin = std::exchange(at, at + F::dimension);
    return displaced_jet<J>(factor, arrow, source + begin, target + begin);
  };
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return ArrowOf<Product<Gs...>, J>{displaced(std::get<I>(groupoid.factor), std::get<I>(g))...};
  }
  (std::index_sequence_for<Gs...>());
}

}  // namespace lagroid
