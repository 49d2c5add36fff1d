#include "certify_system.hpp"
#include "family_laws.hpp"

namespace lagroid::app {

namespace {

class SystemsLaws final : public FamilyLaws {
 public:
  const SceneFamily& family() const override { return systems_family(); }
  Certificate certify(const Section& scene, const CheckOptions& options) const override {
    return certify_system(module_of_scene(scene), scene, options);
  }
};

}  // namespace

const FamilyLaws& systems_laws() {
  static const SystemsLaws laws;
  return laws;
}

}  // namespace lagroid::app
