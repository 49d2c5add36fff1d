#pragma once
/// At which stages inequalities act, and where bounds are reached: what bands of pictures, and lines of reports, show.
///
///     for (const StageRange& each : where_bounds_are_reached(found))
///       shade(found.times[each.first], found.times[each.end]);
///
/// An inequality acts where its multiplier is above a millionth of the largest, and a control is at a bound to a
/// millionth of its size. Of a result that did not converge no inequality acts. Nothing throws.

#include "../control_problem.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace lagroid::app {

/// Stages from `first` up to, and without, `end`.
struct StageRange {
  std::size_t first;
  std::size_t end;
};

/// Which phase each stage is of; empty where the scene has no list of them.
std::vector<std::size_t> phase_of_stages(const ControlResult& found);

/// Any inequality, bounds of controls among them.
std::vector<StageRange> where_inequalities_act(const ControlResult& found);
/// Those rows of gamma that have this name.
std::vector<StageRange> where_it_acts(const ControlResult& found, const std::string& name);
std::vector<StageRange> where_bounds_are_reached(const ControlResult& found);

}  // namespace lagroid::app
