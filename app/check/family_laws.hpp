#pragma once
/// The laws of the kinds of scenes. (Apart from the families themselves, because laws compile long: what knows families
/// is in every program, what knows laws in lagroid-check alone.)

#include "../families/family.hpp"
#include "check_options.hpp"

#include <lagroid/run/certificate.hpp>

#include <vector>

namespace lagroid::app {

class FamilyLaws {
 public:
  virtual ~FamilyLaws() = default;
  virtual const SceneFamily& family() const = 0;
  virtual Certificate certify(const Section& scene, const CheckOptions& options) const = 0;
};

/// Which laws this program has; it says so at its start.
void use_laws(std::vector<const FamilyLaws*> laws);
/// Those of the family that the scene is of. Throws SceneError for what is no motion and no path.
const FamilyLaws& laws_of(const Section& scene);

/// Along the run of a system's scene.
const FamilyLaws& systems_laws();
/// Of the method of a scene on (T*S^2)^k, beside where it starts.
const FamilyLaws& spheres_laws();
/// Of the step of a scene of bodies, where it starts.
const FamilyLaws& bodies_laws();

}  // namespace lagroid::app
