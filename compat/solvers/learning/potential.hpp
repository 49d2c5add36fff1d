#pragma once
/// Moved to <lagroid/solvers/learning/potentials/potential.hpp>; this goes with version 0.4.

#include <lagroid/solvers/learning/potentials/potential.hpp>
