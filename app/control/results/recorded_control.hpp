#pragma once
/// A solution as what a run leaves: columns with names and units, for control.h5, and what its page shows.
///
///     write_trajectory(recorded(found), folder / "control.h5");
///     summary["picture"] = picture_of(found);
///
/// Controls, costates and multipliers are of arrows; states are of nodes. Nothing throws.

#include "../control_problem.hpp"

#include <lagroid/run/run_result.hpp>

#include <nlohmann/json.hpp>

namespace lagroid::app {

RunResult recorded(const ControlResult& found);

/// Shapes and panels as in the summary of a run. Of a panel over time, "bands" are the times at which inequalities act,
/// "levels" the bounds of controls with the times at which they hold, and "steps" says that curves are constant along
/// arrows.
nlohmann::ordered_json picture_of(const ControlResult& found);

}  // namespace lagroid::app
