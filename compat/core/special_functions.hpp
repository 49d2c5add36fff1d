#pragma once
/// Moved to <lagroid/core/scalars/special_functions.hpp>; this goes with version 0.4.

#include <lagroid/core/scalars/special_functions.hpp>
