#pragma once
/// Moved to <lagroid/solvers/step/arclength.hpp>; this goes with version 0.4.

#include <lagroid/solvers/step/arclength.hpp>
