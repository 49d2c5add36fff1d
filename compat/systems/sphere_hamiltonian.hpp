#pragma once
/// Moved to <lagroid/systems/spheres/sphere_hamiltonian.hpp>; this goes with version 0.4.

#include <lagroid/systems/spheres/sphere_hamiltonian.hpp>
