#pragma once
/// Moved to <lagroid/core/number_archive.hpp>; this goes with version 0.4.

#include <lagroid/core/number_archive.hpp>

namespace lagroid {

using Tape [[deprecated("Tape is NumberArchive")]] = NumberArchive;

}  // namespace lagroid
