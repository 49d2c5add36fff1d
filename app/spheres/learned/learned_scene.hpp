#pragma once
/// Scenes of learned Hamiltonians.

#include "../sphere_system.hpp"
#include "model_file.hpp"

namespace lagroid::app {

/// What learned Hamiltonians rest on.
inline constexpr Source learned_hamiltonian_source{"celledoni2023",
                                                   "Hamiltonians on (T*S^2)^k learned through Lie group integrators"};

inline const KeyOf<Text> learned_model_key{
    "model",
    {},
    "",
    "path of the model.json that lagroid learn --out left, seen from the scene or from the working folder"};
inline const std::vector<SphereForm> learned_forms{SphereForm::momenta};

/// [parameters] model = "model.json", as `lagroid learn --out` left it; seen from the working folder.
std::unique_ptr<SphereSystem> read_learned_hamiltonian(const Section& scene);
std::unique_ptr<SphereSystem> system_of(LearnedHamiltonian learned, std::filesystem::path file);
/// What was learned of such a system; null where the system is another.
const LearnedHamiltonian* learned_of(const SphereSystem& system);

}  // namespace lagroid::app
