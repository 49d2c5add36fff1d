#pragma once
/// The time-extended groupoid R x R x G => R x Q.

#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>

namespace lagroid {

/// Arrows (t0, t1, g): a pair of times beside an arrow of G, `const auto& [time, g] = arrow`. Algebroid TR x AG.
/// [G] 6.3
template <class G> using TimeExtended = Product<Pair<1>, G>;

}  // namespace lagroid
