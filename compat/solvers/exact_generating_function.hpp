#pragma once
/// Moved to <lagroid/solvers/generating/exact_generating_function.hpp>; this goes with version 0.4.

#include <lagroid/solvers/generating/exact_generating_function.hpp>
