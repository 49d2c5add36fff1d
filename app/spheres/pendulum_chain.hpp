#pragma once
/// Scenes of chains of spherical pendula.

#include "sphere_system.hpp"

#include <lagroid/systems/pendulums/pendulum_chain.hpp>

#include <vector>

namespace lagroid::app {

std::vector<Key> pendulum_chain_parameters();
/// The usual one first.
inline const std::vector<SphereForm> pendulum_chain_forms{SphereForm::velocities, SphereForm::momenta};
std::unique_ptr<SphereSystem> read_pendulum_chain(const Section& scene);
std::unique_ptr<SphereSystem> system_of(PendulumChain<Eigen::Dynamic> chain);
/// The chain of such a system; null where the system is another.
const PendulumChain<Eigen::Dynamic>* chain_of(const SphereSystem& system);

}  // namespace lagroid::app
