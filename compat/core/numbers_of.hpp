#pragma once
/// Moved to <lagroid/core/scalars/numbers_of.hpp>; this goes with version 0.4.

#include <lagroid/core/scalars/numbers_of.hpp>
