#pragma once
/// Moved to <lagroid/solvers/boundary/multistart.hpp>; this goes with version 0.4.

#include <lagroid/solvers/boundary/multistart.hpp>
