#pragma once
/// Scenes of learned Hamiltonians.

#include "sphere_system.hpp"

namespace lagroid::app {

/// [parameters] model = "model.json", as `lagroid learn --out` left it; seen from the working folder.
std::unique_ptr<SphereSystem> read_learned_hamiltonian(const Section& scene);

}  // namespace lagroid::app
