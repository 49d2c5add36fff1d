#include "../families/family.hpp"
#include "../reading/kinds.hpp"
#include "methods.hpp"
#include "optimisation_scene.hpp"

#include <algorithm>
#include <array>

namespace lagroid::app {

namespace {

class Optimisation final : public SceneFamily {
 public:
  std::string_view key() const override { return keys::optimisation; }
  std::string_view command() const override { return "optimize"; }
  std::vector<Use> uses(const Section& scene) const override {
    const std::string name = read_key(scene.section_or_empty("method"), optimiser_key());
    constexpr std::array<std::string_view, 3> competitors{"gradient-descent", "conjugate-gradients", "trust-region"};
    if (std::find(competitors.begin(), competitors.end(), name) != competitors.end()) return {};
    return {
        {&reference("duruisseaux2022"), "accelerated optimisation by discrete constrained variational integrators"}};
  }
  std::vector<SceneKeys> keys_of_scenes() const override { return {{"optimisation", optimisation_table()}}; }
};

}  // namespace

const SceneFamily& optimisation_family() {
  static const Optimisation family;
  return family;
}

}  // namespace lagroid::app
