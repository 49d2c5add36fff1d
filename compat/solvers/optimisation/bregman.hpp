#pragma once
/// Moved to <lagroid/solvers/optimisation/methods/bregman.hpp>; this goes with version 0.4.

#include <lagroid/solvers/optimisation/methods/bregman.hpp>
