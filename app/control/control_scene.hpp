#pragma once
/// What every scene of an optimal control problem holds beside its parameters: ends, horizon or phases, bounds, solver,
/// loop.

#include "control_problem.hpp"
#include "scene_loop.hpp"
#include "search_keys.hpp"
#include "state_condition.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

using ControlBounds = std::vector<std::pair<double, double>>;  ///< of each control; twice the same: it is fixed

/// A table [weights].
struct WeightsScene {
  std::vector<double> of_controls;
  double of_time = 0;
};

/// A table [[phase]].
struct PhaseScene {
  Section table;  ///< whose [phase.parameters] take the place of the scene's
  std::string name;
  double duration = 1;
  bool duration_is_free = false;
  double shortest = 0;
  double longest = HUGE_VAL;
  long stages = 50;
  ControlBounds bounds;
  std::optional<WeightsScene> weights;           ///< none: those of the scene
  bool constraints_hold = true;                  ///< those of the problem
  std::vector<std::optional<double>> through;    ///< of each number of the state where it ends; none: free
  std::shared_ptr<const StateFormulas> on = {};  ///< what vanishes there
};

/// Whether one of what is free is.
inline bool is_any(const std::vector<bool>& free) { return std::find(free.begin(), free.end(), true) != free.end(); }

struct ControlScene {
  std::vector<double> start;
  std::vector<double> end;
  std::vector<bool> free_start;  ///< of each number of the state
  std::vector<bool> free_end;
  std::shared_ptr<const StateFormulas> start_on = {};  ///< what vanishes at the start
  std::shared_ptr<const StateFormulas> end_on = {};
  std::shared_ptr<const StateFormulas> end_cost = {};  ///< one formula, which is added to the cost
  std::vector<PhaseScene> phases;                      ///< in place of the horizon
  double duration = 1;
  bool duration_is_free = false;
  long stages = 100;
  ControlBounds bounds;
  std::optional<WeightsScene> weights;  ///< of the cost; none: it is the problem's own
  ControlMethod method = ControlMethod::interior_point;
  ControlSearchOptions search;
  std::optional<LoopScene> loop;
};

/// Reads them; `states` and `controls` name what the problem has. Throws SceneError.
ControlScene read_control_scene(const Section& scene, std::span<const std::string> states,
                                std::span<const std::string> controls);

/// Refuses what a control loop cannot look ahead for. Throws SceneError.
void require_loop_scene(const Section& scene, const ControlScene& read);

/// The keys of [boundary], [horizon], [[phase]], [bounds], [weights], [solver] and [loop] of a problem.
std::vector<Key> control_scene_keys(const ControlProblem& problem);

}  // namespace lagroid::app
