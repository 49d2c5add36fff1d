#pragma once
/// The files of a fit: what was measured beside what the fitted run has, as a table and as a picture, and what is told
/// of it.
///
///     const OutputFolder held = folder_for_fit("out/fit", scene, {"run.csv"});
///     std::string note;
///     const auto written = write_fit(fit, "out/fit", note);
///
/// Errors: as output_folder.hpp. `note` says why there are no pictures.

#include "../../reading/scene_reader.hpp"
#include "fit.hpp"

#include <lagroid/run/files/output_folder.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid::app {

/// For this process alone, and for these data alone.
OutputFolder folder_for_fit(const std::filesystem::path& folder, const Section& scene,
                            const std::vector<std::string>& data);

/// residuals.csv, summary.json, summary.txt, figures.gp, plot.svg and plot.png.
std::vector<std::filesystem::path> write_fit(const Fit& fit, const std::filesystem::path& folder, std::string& note);

}  // namespace lagroid::app
