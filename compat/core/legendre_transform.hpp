#pragma once
/// Moved to <lagroid/core/hamiltonian/legendre_transform.hpp>; this goes with version 0.4.

#include <lagroid/core/hamiltonian/legendre_transform.hpp>
