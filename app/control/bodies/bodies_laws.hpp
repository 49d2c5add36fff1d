#pragma once
/// What `lagroid check` asks of a scene of bodies with controls: the laws of its derivatives and of its solution.

#include <lagroid/run/ledger/certificate.hpp>
#include <lagroid/systems/multibody/control/scene_search.hpp>

#include <cstdint>

namespace lagroid::app {

/// Without names of system and groupoid.
Certificate certificate_of(multibody::ControlledScene& scene, const multibody::SceneSearchOptions& search,
                           const multibody::SceneSolver& solve, int samples, std::uint64_t seed);

}  // namespace lagroid::app
