#pragma once
/// The kinds of scenes: which one a scene is, and what can be asked of any.

#include "../reading/scene_reader.hpp"
#include "../scenes/motion_scene.hpp"
#include "../scenes/system_module.hpp"
#include "references.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// The keys of scenes of a kind, and how the kind is called: by a system, or by the family where there is none.
struct SceneKeys {
  std::string name;
  Table table;
};

/// A kind of scene. Commands know no other way to a scene than this.
class SceneFamily {
 public:
  virtual ~SceneFamily() = default;

  /// The key by which a scene says that it is one of them (reading/kinds.hpp).
  virtual std::string_view key() const = 0;
  /// Whether the scene is one of them.
  virtual bool recognises(const Section& scene) const { return scene.has(key()); }
  /// The command that is made for its scenes; `lagroid run` hands them over to it.
  virtual std::string_view command() const { return "run"; }

  /// Reads an initial value, to be run with this context. Throws SceneError for a scene that is none.
  virtual MotionScene read(const Section& scene, const RunContext& context) const;
  /// Runs the scene by the method and the step that it names. Throws SceneError for what is no motion and no path.
  virtual RunResult run(const Section& scene, const RunContext& context) const;
  /// What its system and method rest on; nothing where that is by a classical method. No more is read than says so.
  /// Throws SceneError where there is no such system or method.
  virtual std::vector<Use> uses(const Section& scene) const = 0;
  /// The same of a folder that a command other than `run` left; nothing where the folder is not of this family.
  virtual std::vector<Use> uses_of_folder(const std::filesystem::path&) const { return {}; }
  /// Its systems.
  virtual std::vector<ListedSystem> systems() const { return {}; }
  /// Their names.
  virtual std::vector<std::string> names() const { return {}; }
  /// What its scenes may hold, as they are read.
  virtual std::vector<SceneKeys> keys_of_scenes() const = 0;

 protected:
  /// Throws the SceneError for a scene that is no motion.
  [[noreturn]] void refuse(const Section& scene) const;
  friend const SceneFamily& motions_of(const Section& scene);
};

/// Those of this program, in the order in which their systems are listed; the last is the first to be asked whether a
/// scene is its own. A program says at its start which it has, the family of systems among them.
std::span<const SceneFamily* const> families();
void use_families(std::vector<const SceneFamily*> families);
/// The one that the scene is of: of systems where it is of no other.
const SceneFamily& family_of(const Section& scene);
/// The same of a scene to be studied, checked or run as a motion or a path. Throws SceneError for others.
const SceneFamily& motions_of(const Section& scene);

/// Refuses a scene that is another command's. Throws SceneError.
void require_command(const Section& scene, std::string_view command);

/// Scenes of [[body]], [[joint]] and [[effect]].
const SceneFamily& bodies_family();
/// Scenes on (T*S^2)^k, learned Hamiltonians among them.
const SceneFamily& spheres_family();
/// Scenes that hold the formulas of their system.
const SceneFamily& formula_family();
/// Scenes of Poisson systems.
const SceneFamily& poisson_family();
/// Initial and boundary values of systems whose groupoid is a type.
const SceneFamily& systems_family();
/// The one of `system_modules` that such a scene names. Throws SceneError where it names none.
const SystemModule& module_of_scene(const Section& scene);
/// Functions to be minimised on manifolds.
const SceneFamily& optimisation_family();
/// Optimal control with bounds and inequalities.
const SceneFamily& control_family();
/// Many members of a scene.
const SceneFamily& sweeps_family();

}  // namespace lagroid::app
