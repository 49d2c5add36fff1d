#pragma once
/// One arrow after another of a path whose nodes are displaced.

#include <lagroid/core/groupoid.hpp>

namespace lagroid {

/// The arrow g of a path with its source displaced by u and its target by v: moved = tau(u)^{-1} g tau(v). On entry
/// `back` is tau(u)^{-1} and `product` that of the moved arrows before; on return they are tau(v)^{-1}, for the arrow
/// that comes next, and the product with this one. Projected, so that no round-off adds up.
template <Groupoid G>
void displace_next(const G& groupoid, const ArrowOf<G>& g, const AlgebroidVector<G>& v, ArrowOf<G>& back,
                   ArrowOf<G>& moved, ArrowOf<G>& product) {
  if constexpr (requires { groupoid.displace_next(g, v, back, moved, product); }) {
    groupoid.displace_next(g, v, back, moved, product);
  } else {
    const ArrowOf<G> forth = groupoid.tau(groupoid.target(g), v);
    moved = groupoid.project(groupoid.compose(groupoid.compose(back, g), forth));
    product = groupoid.project(groupoid.compose(product, moved));
    back = groupoid.inverse(forth);
  }
}

}  // namespace lagroid
