#pragma once
/// Moved to <lagroid/solvers/boundary/boundary_problem.hpp>; this goes with version 0.4.

#include <lagroid/solvers/boundary/boundary_problem.hpp>
