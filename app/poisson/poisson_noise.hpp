#pragma once
/// [noise] of Poisson scenes: which of the system's noise Hamiltonians drive it, on which path.

#include "poisson_entry.hpp"

#include <string>
#include <vector>

namespace lagroid::app {

inline constexpr const char* noise_word = "noise";

/// The keys of [noise], as an optional table; none of a system without noise Hamiltonians.
std::vector<Key> noise_keys(const PoissonEntry& entry);
/// What the scene has of it; without a strength where it has none. Throws SceneError.
NoiseOptions read_noise(const Section& scene, const PoissonEntry& entry);
/// Refuses what [time] asks of steps with noise and these do not have.
void refuse_for_noise(const Section& time, const DeclaredMethod& method, const Composition& composition);
/// One sentence on it.
std::string noise_note(const NoiseOptions& noise, const PoissonEntry& entry);

}  // namespace lagroid::app
