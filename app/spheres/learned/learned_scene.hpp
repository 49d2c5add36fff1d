#pragma once
/// Scenes of learned Hamiltonians.

#include "../sphere_system.hpp"

namespace lagroid::app {

/// What learned Hamiltonians rest on.
inline constexpr Source learned_hamiltonian_source{"celledoni2023",
                                                   "Hamiltonians on (T*S^2)^k learned through Lie group integrators"};

/// [parameters] model = "model.json", as `lagroid learn --out` left it; seen from the working folder.
std::unique_ptr<SphereSystem> read_learned_hamiltonian(const Section& scene);

}  // namespace lagroid::app
