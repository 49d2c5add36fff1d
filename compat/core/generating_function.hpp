#pragma once
/// Moved to <lagroid/core/hamiltonian/generating_function.hpp>; this goes with version 0.4.

#include <lagroid/core/hamiltonian/generating_function.hpp>
