#pragma once
/// Systems of a program, by their names, whatever their types: what listings, runs and studies need of each.
///
///     for (const SystemModule* module : system_modules()) std::cout << module->summary() << '\n';
///
/// A module is made by `any_module` (any_system.hpp), or from a function that reads scenes of the system (`ModuleOf`).
/// Errors: SceneError of the scenes that it reads.

#include "../reading/parameter.hpp"
#include "../reading/scene_reader.hpp"
#include "motion_scene.hpp"
#include "prepared_scene.hpp"
#include "simulation.hpp"

#include <lagroid/core/noether.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

/// What `lagroid list` shows of a system that scenes can name.
struct ListedSystem {
  std::string name;
  std::string summary;
  std::string groupoid;
  std::vector<ListedParameter> parameters;
  std::vector<std::string> symmetries;  ///< declared by the system with its default parameters
  std::vector<std::string> conserved;   ///< quantities promised as conserved
};

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
  ListedSystem out{name, summary, Sys::GroupoidType::name(), listed_parameters<Sys>(), {}, {}};
  const Sys system;
  if constexpr (HasSymmetries<Sys>)
    for (const auto& symmetry : system.symmetries()) out.symmetries.push_back(symmetry.name);
  for (const auto& quantity : quantities_of(system))
    if (quantity.promise == Promise::conserved) out.conserved.push_back(quantity.name);
  return out;
}

/// The module of a system, given how its scenes are read; its own methods outlive it.
template <DiscreteSystem Sys> class ModuleOf final : public SystemModule {
 public:
  using Read = std::function<PreparedScene<Sys>(const Section& scene, const RunContext& context)>;
  ModuleOf(std::string name, std::string summary, Read read, std::span<const DeclaredMethod> own_methods = {})
      : SystemModule(std::move(name), std::move(summary)), read_(std::move(read)), own_methods_(own_methods) {}

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

 private:
  Read read_;
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
