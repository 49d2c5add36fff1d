#pragma once
/// Moved to <lagroid/core/derivatives/two_sided.hpp>; this goes with version 0.4.

#include <lagroid/core/derivatives/two_sided.hpp>

namespace lagroid {

template <class Sys> using MixedOf [[deprecated("MixedOf is HyperDualOf")]] = HyperDualOf<Sys>;

}  // namespace lagroid
