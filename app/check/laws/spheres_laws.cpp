#include "../family_laws.hpp"

#include "../../spheres/sphere_run.hpp"
#include "../../spheres/sphere_time.hpp"

#include <lagroid/systems/testing/sphere_laws.hpp>

#include <string>
#include <utility>

namespace lagroid::app {

namespace {

class SpheresLaws final : public FamilyLaws {
 public:
  const SceneFamily& family() const override { return spheres_family(); }
  Certificate certify(const Section& scene, const CheckCommandOptions& options) const override {
    const SphereEntry& entry = *sphere_system_of(scene);
    const SpheresToCheck asked = read_spheres(entry, scene, {}).to_check;
    const SphereSystem& system = *asked.system;
    laws::SphereSubject subject{
        std::string(entry.name),
        asked.options,
        asked.start,
        [&](const auto& start, const auto& by) { return system.begin(start, by); },
        [&](const auto& z, SphereForm from, SphereForm to) { return system.in_form(z, from, to); },
        system.forms()};
    subject.keeps_spheres = keeps_spheres(asked.options);
    const auto quantities = system.quantities();
    for (std::size_t i = 0; i < quantities.size(); ++i)
      if (quantities[i].promise == Promise::conserved)
        subject.conserved = [&, i](const auto& z) {
          const Measured measured = system.measure(z, asked.options.form)[i];
          return std::pair(measured.value, measured.size);
        };
    Certificate certificate;
    certificate.system = entry.name;
    certificate.groupoid = entry.groupoid;
    certificate.states = 1;
    certificate.samples = options.samples;
    certificate.seed = options.seed;
    certificate.suites.push_back(laws::sphere_laws(subject));
    return certificate;
  }
};

}  // namespace

const FamilyLaws& spheres_laws() {
  static const SpheresLaws laws;
  return laws;
}

}  // namespace lagroid::app
