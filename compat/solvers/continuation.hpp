#pragma once
/// Moved to <lagroid/solvers/boundary/continuation.hpp>; this goes with version 0.4.

#include <lagroid/solvers/boundary/continuation.hpp>
