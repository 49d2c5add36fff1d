#pragma once
/// Systems of a program, by their names, whatever their types: what listings, runs and studies need of each.
///
///     for (const SystemModule* module : system_modules()) std::cout << module->summary() << '\n';
///
/// A module is made by `any_module` (any_system.hpp), or from a function that reads scenes of the system (`ModuleOf`).
/// Errors: SceneError of the scenes that it reads.

#include "../keys/parameter.hpp"
#include "../reading/scene_reader.hpp"
#include "motion_scene.hpp"
#include "prepared_scene.hpp"
#include "simulation.hpp"

#include <lagroid/core/capabilities/time_scale_of_arrows.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

/// By what a system can be reduced, and where that leads.
struct ListedReduction {
  std::string name;
  std::string meaning;
  std::string groupoid;
};
/// What `lagroid list` shows of a system that scenes can name.
struct ListedSystem {
  std::string name;
  std::string summary;
  std::string groupoid;
  std::vector<Key> parameters;
  std::vector<std::string> symmetries;  ///< declared by the system with its default parameters
  std::vector<std::string> conserved;   ///< quantities promised as conserved
  std::vector<ListedReduction> reductions = {};
};

/// The keys of a system's own tables, as its reader reads them.
struct SystemKeys {
  std::vector<Key> parameters;
  std::vector<Key> initial;
  std::vector<Key> end = {};     ///< of start and end in [boundary]; none where it has no boundary values
  std::vector<Key> solver = {};  ///< of [solver] beside an initial value, besides those of every system
  bool depends_on_time = false;
  std::vector<std::string> boundary_modes = {};  ///< of [time] beside a boundary value
  std::vector<std::string> reductions = {};      ///< by which `reduce` beside an initial value can ask
};

/// The words of [time] mode of a boundary value.
template <DiscreteSystem Sys> std::vector<std::string> boundary_modes() {
  std::vector<std::string> modes{std::string(mode_of_equal_steps)};
  const auto add = [&](TimeMode mode) { modes.emplace_back(integration_method({.mode = mode}).name); };
  if (Timed<Sys>) add(TimeMode::adaptive);
  if (HasTimeScaleOfArrows<Sys>) {
    add(TimeMode::prescribed);
    add(TimeMode::controlled);  // the word for it until 0.4
  }
  return modes;
}
/// With what the system's type says of time and of its reductions.
template <DiscreteSystem Sys> SystemKeys with_declarations(SystemKeys keys) {
  keys.depends_on_time = TimeDependent<Sys>;
  keys.boundary_modes = boundary_modes<Sys>();
  keys.reductions = names_of_reductions<Sys>();
  return keys;
}

/// A system that scenes can name, with all that a program does with it.
class SystemModule {
 public:
  SystemModule(std::string name, std::string summary) : name_(std::move(name)), summary_(std::move(summary)) {}
  virtual ~SystemModule() = default;

  const std::string& name() const { return name_; }
  const std::string& summary() const { return summary_; }
  virtual bool nonholonomic() const = 0;
  /// Its methods beside those declared for every system.
  virtual std::span<const DeclaredMethod> own_methods() const = 0;
  virtual ListedSystem listed() const = 0;
  virtual SystemKeys keys() const = 0;

  /// Runs an initial or a boundary value.
  virtual RunResult run(const Section& scene, const RunContext& context) const = 0;
  /// Reads an initial value. Throws SceneError for a boundary value.
  virtual MotionScene read(const Section& scene, const RunContext& context) const = 0;

 private:
  std::string name_;
  std::string summary_;
};

/// What `list` shows of a system with its default parameters.
template <DiscreteSystem Sys> ListedSystem listed_system(const std::string& name, const std::string& summary) {
  ListedSystem out{name, summary, Sys::GroupoidType::name(), parameter_keys<Sys>(), {}, {}};
  const Sys system;
  if constexpr (HasSymmetries<Sys>)
    for (const auto& symmetry : system.symmetries()) out.symmetries.push_back(symmetry.name);
  for (const auto& quantity : quantities_of(system))
    if (quantity.promise == Promise::conserved) out.conserved.push_back(quantity.name);
  for_each_reduction<Sys>([&]<class Declared>(const Declared& declared) {
    out.reductions.push_back({std::string(declared.name), std::string(declared.meaning), Declared::Codomain::name()});
  });
  return out;
}

/// The module of a system, given how its scenes are read; its own methods outlive it.
template <DiscreteSystem Sys> class ModuleOf final : public SystemModule {
 public:
  using Read = std::function<PreparedScene<Sys>(const Section& scene, const RunContext& context)>;
  /// `keys` are made when they are asked for.
  using Keys = std::function<SystemKeys()>;
  ModuleOf(std::string name, std::string summary, Read read, Keys keys,
           std::span<const DeclaredMethod> own_methods = {})
      : SystemModule(std::move(name), std::move(summary)),
        read_(std::move(read)),
        keys_(std::move(keys)),
        own_methods_(own_methods) {}

  PreparedScene<Sys> prepare(const Section& scene, const RunContext& context) const { return read_(scene, context); }

  bool nonholonomic() const override { return Nonholonomic<Sys>; }
  std::span<const DeclaredMethod> own_methods() const override { return own_methods_; }
  RunResult run(const Section& scene, const RunContext& context) const override {
    return prepare(scene, context).run(nullptr);
  }
  MotionScene read(const Section& scene, const RunContext& context) const override {
    const PreparedScene<Sys> read = prepare(scene, context);
    if (!read.begin)
      scene.fail("boundary", "a study compares how initial values are integrated: give a scene with [initial]");
    return {read.begin(), read_extent(scene, context), read.methods};
  }
  ListedSystem listed() const override { return listed_system<Sys>(name(), summary()); }
  SystemKeys keys() const override { return with_declarations<Sys>(keys_()); }

 private:
  Read read_;
  Keys keys_;
  std::span<const DeclaredMethod> own_methods_;
};

/// The systems of this program, in the order in which they are listed. A program sets them at its start.
std::span<const SystemModule* const> system_modules();
void use_systems(std::vector<const SystemModule*> modules);

/// The module of that type, if it is one.
template <DiscreteSystem Sys> const ModuleOf<Sys>* module_of(const SystemModule& module) {
  return dynamic_cast<const ModuleOf<Sys>*>(&module);
}

}  // namespace lagroid::app
