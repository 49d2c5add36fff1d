#pragma once
/// Moved to <lagroid/solvers/linear_algebra/small_inverse.hpp>; this goes with version 0.4.

#include <lagroid/solvers/linear_algebra/small_inverse.hpp>
