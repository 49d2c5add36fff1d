#pragma once
/// Scenes whose system is written in them: `system = "lagrangian"` with a table [lagrangian] of formulas, or
/// `system = "hamiltonian"` with [hamiltonian].
///
///     const FormulaScene scene = read_formula(read_scene("elastic_pendulum.toml", {}), context);
///
/// Errors: SceneError for a mistake in a formula, a start off the constraints, a symmetry that is none, or a method
/// that does not take what is written.

#include "../families/references.hpp"
#include "../scenes/motion_scene.hpp"
#include "formula_methods.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// A scene whose steps are to be asked their laws.
struct FormulaToCheck {
  std::string name;
  std::shared_ptr<const FormulaSystem> system;
  /// The method that the scene names, of this system or of one with other parameters.
  std::function<FormulaMethod(const FormulaSystem& system)> begun;
  std::function<FormulaMethod()> precise;  ///< one of high order, whose short steps are the motion to round-off
  SizedState start;
  double step;
  double begin;
};
/// A scene that has been read.
struct FormulaScene : MotionScene {
  FormulaToCheck to_check;
};
FormulaScene read_formula(const Section& scene, const RunContext& context);

/// The words of `system` that such scenes have; each is the name of their table too.
bool is_formula_word(std::string_view word);
/// The keys of that table, of [initial] and of [time].
Table formula_table(std::string_view word);
Table formula_start_table(std::string_view word);
Table formula_time_table(std::string_view word);
/// What the method that [time] names rests on.
std::vector<Use> uses_of_formula(const Section& scene);

}  // namespace lagroid::app
