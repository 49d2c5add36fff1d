#pragma once
/// Moved to <lagroid/core/hamiltonian/homogeneous_space.hpp>; this goes with version 0.4.

#include <lagroid/core/hamiltonian/homogeneous_space.hpp>
