#include "../reading/kinds.hpp"
#include "learned/learned_scene.hpp"
#include "pendulum_chain.hpp"
#include "sphere_system.hpp"

#include <lagroid/systems/pendulums/chain_rattle.hpp>

namespace lagroid::app {

const std::vector<SphereEntry>& sphere_systems() {
  static const std::vector<SphereEntry> all{{keys::pendulum_chain,
                                             "chain of spherical pendula",
                                             "SE(3)^k acting on (T*S^2)^k",
                                             pendulum_chain_parameters(),
                                             {"turning about the vertical"},
                                             {"vertical angular momentum"},
                                             pendulum_chain_forms,
                                             {rattle_method},
                                             {},
                                             read_pendulum_chain},
                                            {keys::learned_hamiltonian,
                                             "a Hamiltonian that lagroid learn found",
                                             "SE(3)^k acting on (T*S^2)^k",
                                             {learned_model_key},
                                             {},
                                             {},
                                             learned_forms,
                                             {},
                                             learned_hamiltonian_source,
                                             read_learned_hamiltonian}};
  return all;
}

const SphereEntry* sphere_system_of(const Section& scene) {
  if (scene.has("body") || !scene.has("system")) return nullptr;
  const std::string name = scene.text("system", "the name of a system, as lagroid list tells them");
  for (const SphereEntry& entry : sphere_systems())
    if (entry.name == name) return &entry;
  return nullptr;
}

}  // namespace lagroid::app
