#pragma once
/// Moved to <lagroid/core/scalars/jet.hpp>; this goes with version 0.4.

#include <lagroid/core/scalars/jet.hpp>
