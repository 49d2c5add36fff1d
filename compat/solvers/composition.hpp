#pragma once
/// Moved to <lagroid/solvers/integrators/composition.hpp>; this goes with version 0.4.

#include <lagroid/solvers/integrators/composition.hpp>
