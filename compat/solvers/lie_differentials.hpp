#pragma once
/// Moved to <lagroid/solvers/newton/lie_differentials.hpp>; this goes with version 0.4.

#include <lagroid/solvers/newton/lie_differentials.hpp>
