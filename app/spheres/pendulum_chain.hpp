#pragma once
/// Scenes of chains of spherical pendula.

#include "sphere_system.hpp"

namespace lagroid::app {

std::unique_ptr<SphereSystem> read_pendulum_chain(const Section& scene);

}  // namespace lagroid::app
