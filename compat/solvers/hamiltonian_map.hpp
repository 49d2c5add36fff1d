#pragma once
/// Moved to <lagroid/solvers/generating/hamiltonian_map.hpp>; this goes with version 0.4.

#include <lagroid/solvers/generating/hamiltonian_map.hpp>
