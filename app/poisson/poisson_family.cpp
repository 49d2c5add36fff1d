#include "poisson_family.hpp"

#include "../reading/kinds.hpp"
#include "../scenes/scene_keys.hpp"
#include "../scenes/simulation.hpp"
#include "poisson_noise.hpp"
#include "poisson_run.hpp"

#include <lagroid/solvers/poisson/poisson_methods.hpp>

#include <utility>

namespace lagroid::app {

PoissonFamily::PoissonFamily(std::vector<PoissonEntry> entries) : entries_(std::move(entries)) {}

PoissonFamily::PoissonFamily(const std::vector<const PoissonEntry*>& entries) {
  for (const PoissonEntry* each : entries) entries_.push_back(*each);
}

const PoissonEntry* PoissonFamily::entry_of(const Section& scene) const {
  if (scene.has("body") || !scene.has("system")) return nullptr;
  const std::string name = scene.text("system", "the name of a system, as lagroid list tells them");
  for (const PoissonEntry& each : entries_)
    if (each.name == name) return &each;
  return nullptr;
}

std::string_view PoissonFamily::key() const { return keys::system; }

MotionScene PoissonFamily::read(const Section& scene, const RunContext& context) const {
  return read_poisson(*entry_of(scene), scene, context);
}

std::vector<Use> PoissonFamily::uses(const Section& scene) const {
  std::vector<Use> uses;
  const ReadMethod method = read_poisson_method(scene.section_or_empty("time"), *entry_of(scene));
  add_use(method.declared->source, uses);
  add_use(source_of(method.composition), uses);
  if (scene.has(noise_word)) {
    add_use(poisson_methods::noise_source, uses);
    if (scene.section_or_empty(noise_word).has("temperature")) add_use(poisson_methods::thermostat_source, uses);
  }
  return uses;
}

std::vector<ListedSystem> PoissonFamily::systems() const {
  std::vector<ListedSystem> all;
  for (const PoissonEntry& entry : entries_)
    all.push_back(
        {entry.name, entry.summary, "symplectic groupoid of " + entry.bracket, entry.parameters, {}, entry.casimirs});
  return all;
}

std::vector<SceneKeys> PoissonFamily::keys_of_scenes() const {
  std::vector<SceneKeys> all;
  for (const PoissonEntry& entry : entries_) {
    Table table{{KeyOf<OneOf>{std::string(keys::system), {{entry.name}}, "", entry.summary},
                 optional_table("output", output_table(), "what is recorded")}};
    for (const Key& key : noise_keys(entry)) table.keys.push_back(key);
    if (!entry.parameters.empty())
      table.keys.push_back(optional_table("parameters", {entry.parameters}, "of the system"));
    table.kinds = initial_values({KeyOf<Table>{"initial", poisson_start_table(entry), "", "the state to start from"}},
                                 poisson_time_table(entry));
    table.about = entry.summary;
    all.push_back({entry.name, std::move(table)});
  }
  return all;
}

std::vector<std::string> PoissonFamily::names() const {
  std::vector<std::string> all;
  for (const PoissonEntry& entry : entries_) all.push_back(entry.name);
  return all;
}

}  // namespace lagroid::app
