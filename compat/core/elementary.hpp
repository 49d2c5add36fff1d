#pragma once
/// Moved to <lagroid/core/scalars/elementary.hpp>; this goes with version 0.4.

#include <lagroid/core/scalars/elementary.hpp>
