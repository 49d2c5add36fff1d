#pragma once
/// Moved to <lagroid/solvers/generating/loop_integral.hpp>; this goes with version 0.4.

#include <lagroid/solvers/generating/loop_integral.hpp>
