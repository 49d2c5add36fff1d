#pragma once
/// Moved to <lagroid/core/scalars/series.hpp>; this goes with version 0.4.

#include <lagroid/core/scalars/series.hpp>
