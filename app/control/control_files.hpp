#pragma once
/// What `lagroid control` prints and writes.

#include "control_problem.hpp"

#include <lagroid/run/files/output_folder.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid::app {

std::string control_text(const ControlResult& found);
nlohmann::ordered_json control_json(const ControlResult& found);

/// The folder, taken for a solution of this scene. Throws FolderRefused.
OutputFolder folder_for_control(const std::filesystem::path& folder, const Section& scene);
/// control.h5, trajectory.csv, summary.json (with what its page shows, `picture`), summary.txt and plots: all or
/// none. Returns what was written; `note` says why there are no pictures.
std::vector<std::filesystem::path> write_control(const ControlResult& found, const std::filesystem::path& folder,
                                                 std::string& note);

}  // namespace lagroid::app
