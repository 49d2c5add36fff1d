#pragma once
/// A path g_1 ... g_N whose nodes are displaced: arrow k becomes tau(v_{k-1})^{-1} g_k tau(v_k).
///
/// Corrections of a boundary value are displacements of its nodes. Taken one after another, an arrow needs but one new
/// retraction.
///
///     ArrowOf<G> back = start, moved = start, product = start;  // the unit at the first node, which stays
///     for (std::size_t k = 0; k < path.size(); ++k) displace_next(groupoid, path[k], v[k], back, moved, product);
///
/// Requires that the arrows are given in order, each with what the call before left in `back` and `product`. Errors are
/// those of `compose`.

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
