#pragma once
/// Scenes of chains of spherical pendula.

#include "sphere_system.hpp"

#include <vector>

namespace lagroid::app {

std::vector<Key> pendulum_chain_parameters();
/// The usual one first.
inline const std::vector<SphereForm> pendulum_chain_forms{SphereForm::velocities, SphereForm::momenta};
std::unique_ptr<SphereSystem> read_pendulum_chain(const Section& scene);

}  // namespace lagroid::app
