#pragma once
/// Moved to <lagroid/core/scalars/pack.hpp>; this goes with version 0.4.

#include <lagroid/core/scalars/pack.hpp>

namespace lagroid {

template <class T, int N> using Lanes [[deprecated("Lanes is Pack")]] = Pack<T, N>;

}  // namespace lagroid
