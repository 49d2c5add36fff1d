#include "family_laws.hpp"

#include <utility>

namespace lagroid::app {

namespace {

std::vector<const FamilyLaws*>& known() {
  static std::vector<const FamilyLaws*> laws;
  return laws;
}

}  // namespace

void use_laws(std::vector<const FamilyLaws*> laws) { known() = std::move(laws); }

const FamilyLaws& laws_of(const Section& scene) {
  const SceneFamily& family = family_of(scene);
  for (const FamilyLaws* laws : known())
    if (&laws->family() == &family) return *laws;
  motions_of(scene);  // says what carries it out, of what is no motion
  scene.fail("", "is of a kind that this program has no laws of");
}

}  // namespace lagroid::app
