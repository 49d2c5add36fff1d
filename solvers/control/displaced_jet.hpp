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

#include <array>
#include <cstddef>
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

/// x with its directions, n by n, in the places from each of `at` on.
template <class J, int n, class Few, std::size_t Blocks>
J with_directions_at(const Few& x, const std::array<int, Blocks>& at) {
  const auto widened = [&](const auto& few) {
    auto out = J::along(0, 0.0);
    for (int i = 0; i < n; ++i)
      for (std::size_t block = 0; block < Blocks; ++block) out.set(at[block] + i, few(int(block) * n + i));
    return out;
  };
  J out(x.value, widened([&](int i) { return x.gradient(i); }));
  if constexpr (requires { x.hessian(0, 0); })
    for (std::size_t block = 0; block < Blocks; ++block)
      for (int i = 0; i < n; ++i)
        out.set_row(at[block] + i, widened([&, row = int(block) * n + i](int j) { return x.hessian(row, j); }));
  return out;
}

/// g displaced at its last `Blocks` ends, along the infinitesimals from `at` on.
template <class J, std::size_t Blocks, class G>
auto displaced_at(const G& groupoid, const ArrowOf<G>& g, const std::array<int, Blocks>& at) {
  constexpr int n = G::dimension;
  constexpr int before_target = (int(Blocks) - 1) * n;
  using Few = typename WithDirections<J, before_target + n>::Type;
  Vector<Few, n> a;
  Vector<Few, n> b;
  for (int i = 0; i < n; ++i) {
    a(i) = Blocks == 2 ? Few::variable(0, i) : Few(0.0);
    b(i) = Few::variable(0, before_target + i);
  }
  const auto few = groupoid.coordinates_of_arrow(groupoid.translate(a, groupoid.template cast<Few>(g), b));
  Vector<J, G::arrow_coordinate_count()> x;
  for (int i = 0; i < x.size(); ++i) x(i) = with_directions_at<J, n>(few(i), at);
  return groupoid.template arrow_at<J>(x);
}
template <class J, std::size_t Blocks, class... Gs>
auto displaced_at(const Product<Gs...>& groupoid, const ArrowOf<Product<Gs...>>& g, std::array<int, Blocks> at) {
  const auto displaced = [&]<class F, class A>(const F& factor, const A& arrow) {
    const auto here = at;
    for (int& place : at) place += F::dimension;
    return displaced_at<J, Blocks>(factor, arrow, here);
  };
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return ArrowOf<Product<Gs...>, J>{displaced(std::get<I>(groupoid.factor), std::get<I>(g))...};
  }
  (std::index_sequence_for<Gs...>());
}

}  // namespace detail

template <class J, class G> auto displaced_jet(const G& groupoid, const ArrowOf<G>& g, int source, int target) {
  return detail::displaced_at<J, 2>(groupoid, g, {source, target});
}
/// g tau(b) alone, b_i the infinitesimal Target + i.
template <class J, class G> auto displaced_end_jet(const G& groupoid, const ArrowOf<G>& g, int target) {
  return detail::displaced_at<J, 1>(groupoid, g, {target});
}

}  // namespace lagroid
