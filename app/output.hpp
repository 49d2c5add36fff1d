#pragma once
/// The files of a run: trajectory (HDF5, CSV), summaries, plots.

#include "output_folder.hpp"
#include "run_result.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid::app {

/// The script that draws the panels, from the columns of trajectory.csv by their names or from what is to be seen of
/// them, plot.csv: what a run's plot.gp holds. It follows from what the summary says, so that a script by someone else
/// is told from it.
std::string plot_script(const std::vector<Panel>& panels, bool by_name);

/// Throws OutputError, with the remedy, unless `folder` can be created and written to. Leaves nothing behind.
void require_writable(const std::filesystem::path& folder);

/// Writes trajectory.h5, trajectory.csv, summary.json, summary.txt, plot.gp, plot.svg and plot.png into `folder`
/// (`write_whole`). Returns the files written; a missing or failing gnuplot costs the pictures only and is added to the
/// result's notes.
std::vector<std::filesystem::path> write_outputs(RunResult& result, const std::filesystem::path& folder);

}  // namespace lagroid::app
