#pragma once
/// Which rows of a trajectory its pictures show: a thousand points across, without losing a spike, however long the
/// run.
///
///     const std::vector<Stroke> strokes = visible_strokes(panel, trajectory);
///
/// Requires a panel whose columns the trajectory has.

#include <lagroid/run/run_result.hpp>

#include <string>
#include <vector>

namespace lagroid {

/// Sets the panel's offsets: numbers that differ by less than a thousandth of their size are shown less a round number
/// among them, for else the labels of an axis, which have a few digits each, would all be the same.
void take_offsets(Panel& panel, const Trajectory& trajectory);

/// The axis' label, less the offset.
std::string label_of(const std::string& label, double offset);

/// Rows to be joined by a line.
using Stroke = std::vector<std::size_t>;

/// The rows of a panel that can be distinguished in a picture of a thousand points across, however long the run. Over a
/// column that never falls, as the time, they are the first, the last, and the least and the greatest of every curve in
/// each of a thousand equal parts: no spike is lost. A path in the plane is followed and left out where it has been
/// before, to 1 / 400 of the picture.
std::vector<Stroke> visible_strokes(const Panel& panel, const Trajectory& trajectory);

/// The visible rows of the panels as a table for gnuplot: a block (`index`) for each, its columns x and the curves, an
/// empty line between strokes.
std::string table_of_visible(const std::vector<Panel>& panels, const Trajectory& trajectory);

}  // namespace lagroid
