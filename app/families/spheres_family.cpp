#include "family.hpp"

#include "../spheres/sphere_run.hpp"
#include "../spheres/sphere_system.hpp"

namespace lagroid::app {

namespace {

class Spheres final : public SceneFamily {
 public:
  bool recognises(const Section& scene) const override { return sphere_system_of(scene) != nullptr; }
  MotionScene read(const Section& scene, const RunContext& context) const override {
    return read_spheres(*sphere_system_of(scene), scene, context);
  }
  std::vector<Use> uses(const Section& scene) const override {
    constexpr std::string_view rattle = "rattle";  // of pendulum chains, where no other is named
    std::vector<std::string> names{std::string(rattle)};
    for (const LieGroupMethod& method : lie_group_methods::all) names.emplace_back(method.name);
    const bool learned = sphere_system_of(scene)->name == "learned_hamiltonian";
    std::vector<Use> uses;
    if (learned) uses = uses_of_learning();
    const std::string usual = learned ? names.back() : names.front();
    if (scene.section_or_empty("time").choice_or("method", usual, names) == rattle)
      uses.push_back({&reference("marrero2015"), "discrete mechanics with constraints, of which RATTLE is a case"});
    else
      uses.push_back({&reference("celledoni2022"), "Lie group integrators on products of T*S^2"});
    return uses;
  }
  std::vector<ListedSystem> systems() const override {
    std::vector<ListedSystem> all;
    for (const SphereEntry& entry : sphere_systems())
      all.push_back({std::string(entry.name), std::string(entry.summary), std::string(entry.groupoid), entry.parameters,
                     entry.symmetries, entry.conserved});
    return all;
  }
  std::vector<std::string> names() const override {
    std::vector<std::string> all;
    for (const SphereEntry& entry : sphere_systems()) all.emplace_back(entry.name);
    return all;
  }
};

}  // namespace

const SceneFamily& spheres_family() {
  static const Spheres family;
  return family;
}

}  // namespace lagroid::app
