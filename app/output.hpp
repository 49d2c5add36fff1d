#pragma once
/// The files of a run: trajectory (HDF5, CSV), summaries, plots.

#include "run_result.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::app {

/// Something that a run puts out cannot be written.
class OutputError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws OutputError, with the remedy, unless `folder` can be created and written to. Leaves nothing behind.
void require_writable(const std::filesystem::path& folder);

/// Writes trajectory.h5, trajectory.csv, summary.json, summary.txt, plot.gp, plot.svg and plot.png into `folder`. Every
/// file is completed under another name and then renamed, so that each is there whole or not at all. Removes what
/// killed runs left half-written there. Returns the files written; a missing or failing gnuplot costs the pictures only
/// and is added to the result's notes.
std::vector<std::filesystem::path> write_outputs(RunResult& result, const std::filesystem::path& folder);

}  // namespace lagroid::app
