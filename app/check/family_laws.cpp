#include "family_laws.hpp"

#include <array>

namespace lagroid::app {

const FamilyLaws& laws_of(const Section& scene) {
  const SceneFamily& family = motions_of(scene);
  for (const FamilyLaws* laws : std::array{&systems_laws(), &spheres_laws(), &bodies_laws()})
    if (&laws->family() == &family) return *laws;
  scene.fail("", "is of a kind that has no laws");
}

}  // namespace lagroid::app
