#pragma once
/// Moved to <lagroid/solvers/generating/constrained_momentum.hpp>; this goes with version 0.4.

#include <lagroid/solvers/generating/constrained_momentum.hpp>
