#include "../reading/kinds.hpp"
#include "family.hpp"

#include "../scenes/boundary_value.hpp"
#include "../scenes/scene_keys.hpp"
#include "../scenes/system_module.hpp"

#include <lagroid/solvers/boundary/boundary_words.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace lagroid::app {

namespace {

KeyOf<Table> parameters_key(const std::vector<Key>& keys) {
  if (std::any_of(keys.begin(), keys.end(), [](const Key& key) { return key.required(); }))
    return {"parameters", {keys}, "", "of the system"};
  return optional_table("parameters", {keys}, "of the system");
}

/// The keys of a system's scenes: of initial and of boundary values.
Table scene_table(const SystemModule& module) {
  const SystemKeys own = module.keys();
  Table solver = step_solver_table();
  solver.keys.insert(solver.keys.end(), own.solver.begin(), own.solver.end());
  Table table{{KeyOf<OneOf>{std::string(keys::system), {{module.name()}}, "", module.summary()}}};
  if (!own.parameters.empty()) table.keys.push_back(parameters_key(own.parameters));
  const auto started_with = [&](const KeyOf<Table>& other) {
    return std::vector<Key>{KeyOf<Table>{"initial", {own.initial}, "", "the state to start from"},
                            optional_table("output", output_table(), "what is recorded"), other};
  };
  std::vector<Key> stepped = started_with(optional_table("solver", solver, "of the implicit equations of a step"));
  if (!own.reductions.empty()) stepped.push_back(reduce_key(own.reductions));
  table.kinds = initial_values(stepped, time_table(own.depends_on_time));
  for (const DeclaredMethod& method : module.own_methods())
    table.kinds.push_back(
        {started_with(KeyOf<Table>{"time", own_time_table(method), "", std::string(method.source.what)})});
  if (!own.end.empty())
    table.kinds.push_back({{KeyOf<Table>{"boundary", boundary_table({own.end}), "", "the two ends"},
                            KeyOf<Table>{"time", boundary_time_table(own.boundary_modes, own.depends_on_time), "",
                                         "how long it takes, in how many steps"},
                            optional_table("solver", boundary_solver_table(), "of the boundary value"),
                            optional_table("output", {{output_keys::every}}, "what is recorded"),
                            optional_table("continuation", continuation_table(),
                                           "carries the solutions of an easier problem to this one")}});
  table.about = module.summary();
  return table;
}

class Systems final : public SceneFamily {
 public:
  std::string_view key() const override { return keys::system; }
  /// A boundary value too, and a first step that is found for an accuracy.
  RunResult run(const Section& scene, const RunContext& context) const override {
    return module_of_scene(scene).run(scene, context);
  }
  MotionScene read(const Section& scene, const RunContext& context) const override {
    return module_of_scene(scene).read(scene, context);
  }
  std::vector<Use> uses(const Section& scene) const override {
    const SystemModule& module = module_of_scene(scene);
    std::vector<Use> uses{{&reference("marrero2015"), "discrete constrained mechanics on Lie groupoids"}};
    const Section time = scene.section_or_empty("time");
    const DeclaredMethod& method = read_declared_method(time, module.own_methods());
    add_use(method.source, uses);
    if (const auto compositions = compositions_of(method.other_orders); !compositions.empty())
      add_use(source_of(read_composition(time, compositions)), uses);
    if (module.nonholonomic())
      uses.push_back({&reference("iglesias2008"), "nonholonomic constraints on Lie groupoids"});
    const auto solvers = words_of(boundary_words);
    const std::string solver = scene.section_or_empty("solver").choice_or("method", solvers.front(), solvers);
    if (method.implicit && choice_of(boundary_words, solver) == BoundaryMethod::newton)
      uses.push_back({&reference("owren2000"), "Newton's iteration, carried from Lie groups to groupoids"});
    return uses;
  }
  std::vector<ListedSystem> systems() const override {
    std::vector<ListedSystem> all;
    for (const SystemModule* module : system_modules()) all.push_back(module->listed());
    return all;
  }
  std::vector<std::string> names() const override {
    std::vector<std::string> all;
    for (const SystemModule* module : system_modules()) all.push_back(module->name());
    return all;
  }
  std::vector<SceneKeys> keys_of_scenes() const override {
    std::vector<SceneKeys> all;
    for (const SystemModule* module : system_modules()) all.push_back({module->name(), scene_table(*module)});
    return all;
  }
};

}  // namespace

const SceneFamily& systems_family() {
  static const Systems family;
  return family;
}

const SystemModule& module_of_scene(const Section& scene) {
  if (!scene.has(keys::system)) {
    std::string remedy = "the name of one, as lagroid list tells them";
    for (const SceneFamily* family : families())
      if (family->key() != keys::system)
        remedy += fmt::format("; or {}, for lagroid {}", family->key(), family->command());
    scene.text(keys::system, remedy);  // it is not there
  }
  std::vector<std::string> names;
  for (const SceneFamily* family : families())
    for (std::string& each : family->names()) names.push_back(std::move(each));
  const std::string name = scene.choice(keys::system, names);
  for (const SystemModule* module : system_modules())
    if (module->name() == name) return *module;
  scene.fail("system", "is of another kind than those whose groupoid is a type");
}

}  // namespace lagroid::app
