#pragma once
/// Moved to <lagroid/core/scalars/hyper_dual.hpp>; this goes with version 0.4.

#include <lagroid/core/scalars/hyper_dual.hpp>

namespace lagroid {

template <class T, int L, int R> using Mixed [[deprecated("Mixed is HyperDual")]] = HyperDual<T, L, R>;

}  // namespace lagroid
