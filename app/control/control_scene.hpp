#pragma once
/// What every scene of an optimal control problem holds beside its parameters: ends, horizon, bounds, solver, loop.

#include "control_problem.hpp"
#include "scene_loop.hpp"

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

enum class ControlMethod { interior_point, ipopt };

struct ControlScene {
  std::vector<double> start;
  std::vector<double> end;
  double duration = 1;
  bool duration_is_free = false;
  long stages = 100;
  std::vector<std::pair<double, double>> bounds;  ///< of each control
  ControlMethod method = ControlMethod::interior_point;
  ControlSearchOptions search;
  std::optional<LoopScene> loop;
};

/// Reads them; `states` and `controls` name what the problem has. Throws SceneError.
ControlScene read_control_scene(const Section& scene, std::span<const std::string> states,
                                std::span<const std::string> controls);

/// The keys of [boundary], [horizon], [bounds], [solver] and [loop] of a problem.
std::vector<Key> control_scene_keys(const ControlProblem& problem);

}  // namespace lagroid::app
