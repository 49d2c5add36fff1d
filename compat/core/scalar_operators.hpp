#pragma once
/// Moved to <lagroid/core/scalars/scalar_operators.hpp>; this goes with version 0.4.

#include <lagroid/core/scalars/scalar_operators.hpp>
