#pragma once
/// The files of a run: trajectory (HDF5, CSV), summaries, plots.

#include "output_folder.hpp"
#include "run_result.hpp"

#include <filesystem>
#include <vector>

namespace lagroid::app {

/// Throws OutputError, with the remedy, unless `folder` can be created and written to. Leaves nothing behind.
void require_writable(const std::filesystem::path& folder);

/// Writes trajectory.h5, trajectory.csv, summary.json, summary.txt, plot.gp, plot.svg and plot.png into `folder`
/// (`write_whole`). Returns the files written; a missing or failing gnuplot costs the pictures only and is added to the
/// result's notes.
std::vector<std::filesystem::path> write_outputs(RunResult& result, const std::filesystem::path& folder);

}  // namespace lagroid::app
