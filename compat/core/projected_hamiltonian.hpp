#pragma once
/// Moved to <lagroid/core/hamiltonian/projected_hamiltonian.hpp>; this goes with version 0.4.

#include <lagroid/core/hamiltonian/projected_hamiltonian.hpp>
