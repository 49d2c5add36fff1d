#include "../family_laws.hpp"

#include "../../bodies/scene_run.hpp"

#include <lagroid/systems/multibody/testing/scene_laws.hpp>

namespace lagroid::app {

namespace {

class BodiesLaws final : public FamilyLaws {
 public:
  const SceneFamily& family() const override { return bodies_family(); }
  Certificate certify(const Section& scene, const CheckCommandOptions& options) const override {
    const BodiesToCheck bodies = read_bodies(scene, {}).to_check;
    Certificate certificate;
    certificate.system = bodies.name;
    certificate.groupoid = "the product of its bodies' groupoids";
    certificate.states = 1;
    certificate.samples = 1;
    certificate.seed = options.seed;
    certificate.suites.push_back(laws::scene_laws(
        {bodies.name, bodies.make, bodies.step, 20 * bodies.step, bodies.symplectic, bodies.reversible}));
    return certificate;
  }
};

}  // namespace

const FamilyLaws& bodies_laws() {
  static const BodiesLaws laws;
  return laws;
}

}  // namespace lagroid::app
