#pragma once
/// Moved to <lagroid/core/hamiltonian/lagrangian.hpp>; this goes with version 0.4.

#include <lagroid/core/hamiltonian/lagrangian.hpp>
