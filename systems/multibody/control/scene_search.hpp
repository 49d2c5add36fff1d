#pragma once
/// Optimal control of a scene of bodies, from many starts: one start finds one local minimum.
///
///     const SceneSearch found = search_scene(task, {.starts = 4});
///     if (!found.minima.empty()) std::cout << found.minima.front().report.cost << '\n';  // the cheapest
///
/// The first start leads straight from the scene's start to its end, by way of where the joints hold; the second is the
/// motion without controls, bent toward the end; the others are straight ones bent at random. All have the momenta of
/// their motion. Requires what ControlledScene requires (std::invalid_argument otherwise). Returns the distinct
/// solutions, cheapest first, and how every start ended. The same seed finds the same.

#include <lagroid/solvers/control/optimality/crossed_solution.hpp>
#include <lagroid/systems/multibody/control/scene_transcription.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

namespace lagroid::multibody {

struct SceneSearchOptions {
  int starts = 4;
  std::uint64_t seed = 1;
  double amplitude = 0;  ///< of bends, m and rad; 0: the way from start to end, or one
  /// A start is given up after so many times the iterations of the slowest that has converged, at least 100. 0: none
  /// is.
  double patience = 4;
  ControlOptions solver = {};
};

struct SceneSolution {
  ScenePath path;
  StageRows costates;                ///< of the stages' equations, behind them those of joints, or of the end
  StageRows inequality_multipliers;  ///< of NodeLimits, then of finite bounds: of each control upper, lower
  ControlReport report;
  CrossoverReport crossover;
};

struct SceneSearch {
  std::vector<SceneSolution> minima;  ///< distinct ones, cheapest first
  SceneSolution best_failure;         ///< where there are none
  std::map<ControlStatus, int> outcomes;
  int iterations = 0;
};

/// Start `index`, the same whatever the number of starts.
ScenePath scene_guess(ControlledScene& scene, int index, const SceneSearchOptions& options = {});
/// With a node between each two, and the controls of both halves those of the whole.
ScenePath halved(ControlledScene& scene, const ScenePath& path);

/// A solution in which a step turns a body by more than a quarter turn becomes an infeasible one: momenta of steps
/// along chords go as the sine of what they turn by, so that of a light body a step by half a turn costs nothing. Those
/// that solve_scene and solve_scene_by_ipopt return have no such step.
void refuse_wide_steps(const ControlledScene& scene, SceneSolution& solution);

SceneSolution solve_scene(ControlledScene& scene, ScenePath start, const ControlOptions& options = {});

/// What solves from one start.
using SceneSolver = std::function<SceneSolution(ControlledScene&, ScenePath, const ControlOptions&)>;

/// Before each start `keep_going(start)` decides whether it is made.
SceneSearch search_scene(
    ControlledScene& scene, const SceneSearchOptions& options = {},
    const std::function<bool(int start)>& keep_going = [](int) { return true; },
    const SceneSolver& solve = solve_scene);
SceneSearch search_scene(SceneControl task, const SceneSearchOptions& options = {});

}  // namespace lagroid::multibody
