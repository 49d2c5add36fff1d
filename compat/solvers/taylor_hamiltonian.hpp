#pragma once
/// Moved to <lagroid/solvers/generating/taylor_hamiltonian.hpp>; this goes with version 0.4.

#include <lagroid/solvers/generating/taylor_hamiltonian.hpp>
