/// Learned models in a browser, which has no files: nobody may ask for one.

#include <spheres/learned/learned_scene.hpp>

namespace lagroid::app {

std::unique_ptr<SphereSystem> read_learned_hamiltonian(const Section& scene) {
  scene.fail("parameters", "a page reads no files; what lagroid learn leaves as a formula it runs");
}

}  // namespace lagroid::app
