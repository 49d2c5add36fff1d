#pragma once
/// Moved to <lagroid/solvers/newton/lie_newton.hpp>; this goes with version 0.4.

#include <lagroid/solvers/newton/lie_newton.hpp>
