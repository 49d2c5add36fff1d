#include "../reading/kinds.hpp"
#include "family.hpp"

#include "../poisson/poisson_noise.hpp"
#include "../poisson/poisson_run.hpp"
#include "../scenes/scene_keys.hpp"
#include "../scenes/simulation.hpp"

#include <lagroid/solvers/poisson/poisson_methods.hpp>

namespace lagroid::app {

namespace {

class PoissonSystems final : public SceneFamily {
 public:
  std::string_view key() const override { return keys::system; }
  bool recognises(const Section& scene) const override { return poisson_entry_of(scene) != nullptr; }
  MotionScene read(const Section& scene, const RunContext& context) const override {
    return read_poisson(*poisson_entry_of(scene), scene, context);
  }
  std::vector<Use> uses(const Section& scene) const override {
    std::vector<Use> uses;
    const ReadMethod method = read_poisson_method(scene.section_or_empty("time"), *poisson_entry_of(scene));
    add_use(method.declared->source, uses);
    add_use(source_of(method.composition), uses);
    if (scene.has(noise_word)) {
      add_use(poisson_methods::noise_source, uses);
      if (scene.section_or_empty(noise_word).has("temperature")) add_use(poisson_methods::thermostat_source, uses);
    }
    return uses;
  }
  std::vector<ListedSystem> systems() const override {
    std::vector<ListedSystem> all;
    for (const PoissonEntry& entry : poisson_entries())
      all.push_back({std::string(entry.name),
                     std::string(entry.summary),
                     "symplectic groupoid of " + std::string(entry.bracket),
                     entry.parameters,
                     {},
                     entry.casimirs});
    return all;
  }
  std::vector<SceneKeys> keys_of_scenes() const override {
    std::vector<SceneKeys> all;
    for (const PoissonEntry& entry : poisson_entries()) {
      Table table{{KeyOf<OneOf>{std::string(keys::system), {{std::string(entry.name)}}, "", std::string(entry.summary)},
                   optional_table("output", output_table(), "what is recorded")}};
      for (const Key& key : noise_keys(entry)) table.keys.push_back(key);
      if (!entry.parameters.empty())
        table.keys.push_back(optional_table("parameters", {entry.parameters}, "of the system"));
      table.kinds = initial_values({KeyOf<Table>{"initial", poisson_start_table(entry), "", "the state to start from"}},
                                   poisson_time_table(entry));
      table.about = entry.summary;
      all.push_back({std::string(entry.name), std::move(table)});
    }
    return all;
  }
  std::vector<std::string> names() const override {
    std::vector<std::string> all;
    for (const PoissonEntry& entry : poisson_entries()) all.emplace_back(entry.name);
    return all;
  }
};

}  // namespace

const SceneFamily& poisson_family() {
  static const PoissonSystems family;
  return family;
}

}  // namespace lagroid::app
