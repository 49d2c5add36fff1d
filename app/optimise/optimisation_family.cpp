#include "../families/family.hpp"
#include "../reading/kinds.hpp"
#include "methods.hpp"

#include <algorithm>
#include <array>

namespace lagroid::app {

namespace {

class Optimisation final : public SceneFamily {
 public:
  std::string_view key() const override { return keys::optimisation; }
  std::string_view command() const override { return "optimize"; }
  std::vector<Use> uses(const Section& scene) const override {
    std::vector<std::string> names;
    for (const auto& entry : optimisers()) names.emplace_back(entry.name);
    const std::string name = scene.section_or_empty("method").choice_or("name", names.front(), names);
    constexpr std::array<std::string_view, 3> competitors{"gradient-descent", "conjugate-gradients", "trust-region"};
    if (std::find(competitors.begin(), competitors.end(), name) != competitors.end()) return {};
    return {
        {&reference("duruisseaux2022"), "accelerated optimisation by discrete constrained variational integrators"}};
  }
};

}  // namespace

const SceneFamily& optimisation_family() {
  static const Optimisation family;
  return family;
}

}  // namespace lagroid::app
