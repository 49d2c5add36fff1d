#pragma once
/// Moved to <lagroid/core/source_fibre.hpp>; this goes with version 0.4.

#include <lagroid/core/source_fibre.hpp>

namespace lagroid {

template <class F>
concept AlphaFibre = SourceFibre<F>;

}  // namespace lagroid
