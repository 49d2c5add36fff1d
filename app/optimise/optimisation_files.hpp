#pragma once
/// What a minimisation leaves: words, JSON, files.

#include "optimisation_scene.hpp"

#include <lagroid/run/files/output_folder.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid::app {

/// Status, value, gradient, residual of the constraints, costs, reference; numbers read back to the same doubles.
nlohmann::ordered_json optimisation_json(const OptimisationScene& scene, const optimisation::Result& result);
std::string optimisation_text(const OptimisationScene& scene, const optimisation::Result& result);

/// The folder for them, for this process alone. Throws as OutputFolder does.
OutputFolder folder_for_optimisation(const std::filesystem::path& folder, const Section& scene);

/// history.csv, result.h5 (the point as the data set /x), summary.json, summary.txt, plot.gp and its pictures. `note`
/// says why there are no pictures, where there are none.
std::vector<std::filesystem::path> write_optimisation(const OptimisationScene& scene,
                                                      const optimisation::Result& result,
                                                      const std::filesystem::path& folder, std::string& note);

}  // namespace lagroid::app
