#pragma once
/// Scenes of chains of spherical pendula.

#include "sphere_system.hpp"

#include <vector>

namespace lagroid::app {

std::vector<ListedParameter> pendulum_chain_parameters();
std::unique_ptr<SphereSystem> read_pendulum_chain(const Section& scene);

}  // namespace lagroid::app
