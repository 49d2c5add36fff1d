#include "../reading/kinds.hpp"
#include "family.hpp"

#include "../scenes/scene_keys.hpp"
#include "../scenes/simulation.hpp"
#include "../spheres/learned/learned_scene.hpp"
#include "../spheres/learned/model_file.hpp"
#include "../spheres/sphere_run.hpp"
#include "../spheres/sphere_start.hpp"
#include "../spheres/sphere_system.hpp"
#include "../spheres/sphere_time.hpp"

namespace lagroid::app {

namespace {

class Spheres final : public SceneFamily {
 public:
  std::string_view key() const override { return keys::system; }
  bool recognises(const Section& scene) const override { return sphere_system_of(scene) != nullptr; }
  MotionScene read(const Section& scene, const RunContext& context) const override {
    return read_spheres(*sphere_system_of(scene), scene, context);
  }
  std::vector<Use> uses(const Section& scene) const override {
    const SphereEntry& entry = *sphere_system_of(scene);
    const Section time = scene.section_or_empty("time");
    std::vector<Use> uses;
    add_use(entry.source, uses);
    const std::string name = read_sphere_method(time, entry);
    if (const DeclaredMethod* own = own_method(entry, name)) {
      add_use(own->source, uses);
      add_use(source_of(read_composition(time, compositions_of(own->other_orders))), uses);
    } else if (name == extrapolation_method.name) {
      add_use(extrapolation_method.source, uses);
    } else if (const Source source = source_of(*lie_group_methods::named(name)); !source.key.empty()) {
      add_use({"celledoni2022", "Lie group integrators on products of T*S^2"}, uses);
      add_use(source, uses);
    }
    return uses;
  }
  /// What `lagroid learn` leaves is a system that a scene of this family runs.
  std::vector<Use> uses_of_folder(const std::filesystem::path& folder) const override {
    std::vector<Use> uses;
    if (std::filesystem::exists(folder / model_file_name)) add_use(learned_hamiltonian_source, uses);
    return uses;
  }
  std::vector<ListedSystem> systems() const override {
    std::vector<ListedSystem> all;
    for (const SphereEntry& entry : sphere_systems())
      all.push_back({std::string(entry.name), std::string(entry.summary), std::string(entry.groupoid), entry.parameters,
                     entry.symmetries, entry.conserved});
    return all;
  }
  std::vector<SceneKeys> keys_of_scenes() const override {
    std::vector<SceneKeys> all;
    for (const SphereEntry& entry : sphere_systems()) {
      Table table{{KeyOf<OneOf>{std::string(keys::system), {{std::string(entry.name)}}, "", std::string(entry.summary)},
                   KeyOf<Table>{"parameters", {entry.parameters}, "", "of the system"},
                   optional_table("output", output_table(), "what is recorded")}};
      table.kinds =
          initial_values({KeyOf<Table>{"initial", sphere_start_table(entry.forms), "", "the state to start from"}},
                         sphere_time_table(entry));
      table.about = entry.summary;
      all.push_back({std::string(entry.name), std::move(table)});
    }
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
