#pragma once
/// The files of a run: trajectory (HDF5, CSV), summaries, plots.
///
///     const OutputFolder held = folder_for_run("out/run", scene_text);
///     const auto files = write_outputs(result, "out/run");
///
/// Requires that the caller holds the folder (OutputFolder). Returns the files written; a missing gnuplot costs the
/// pictures only, and RunResult::notes has why.
///
/// Errors: OutputError and FolderRefused, with the remedy.

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/run_result.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid {

/// The script that draws the panels, from the columns of trajectory.csv by their names or from what is to be seen of
/// them, plot.csv: what a run's plot.gp holds, with marks where an event happened and a panel for each that is drawn as
/// a section. It follows from the summary, so that a script that someone else wrote can be distinguished from it.
std::string plot_script(const std::vector<Panel>& panels, const EventTable& events, bool by_name);

/// The folder for a run of that scene (what was run, as text), or that of a run which is there, to go on with it or to
/// show it; for this process alone. Throws as OutputFolder does.
OutputFolder folder_for_run(const std::filesystem::path& folder, const std::string& scene);
OutputFolder folder_of_run(const std::filesystem::path& folder);
/// The same for a result whose scene is not known: it may be written again, another one may not.
OutputFolder folder_for_result(const std::filesystem::path& folder, const RunResult& result);

/// The columns of a result, with what happened in it, as HDF5. Throws OutputError.
void write_trajectory(const RunResult& result, const std::filesystem::path& file);

/// Writes trajectory.h5, trajectory.csv, events.csv where events were watched for, summary.json, summary.txt, plot.gp,
/// plot.svg and plot.png into `folder`
/// (`write_and_draw`), which the caller holds. Returns the files written; a missing or failing gnuplot, or a signal
/// while it draws, costs the pictures only and is added to the result's notes.
std::vector<std::filesystem::path> write_outputs(RunResult& result, const std::filesystem::path& folder);

/// The same of what must not be lost with its files: where they cannot be written, RunResult::output_error has the
/// reason, and a signal that comes meanwhile is noted (InterruptGuard).
std::vector<std::filesystem::path> write_outputs_if_possible(RunResult& result, const std::filesystem::path& folder);

}  // namespace lagroid
