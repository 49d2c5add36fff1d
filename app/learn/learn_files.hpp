#pragma once
/// What a training says and leaves.

#include "../spheres/learned/model_file.hpp"
#include "learn.hpp"

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/solvers/learning/measures.hpp>
#include <lagroid/solvers/learning/train.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::app {

/// All that is known after a training.
struct TrainingOutcome {
  LearnOptions options;
  LearnedHamiltonian learned;
  learning::Trained trained;
  learning::Trajectories data;
  std::optional<learning::Trajectories> test;
  std::optional<learning::Measures> measures;  ///< on the latter
  std::vector<std::string> notes;
};

std::string training_text(const TrainingOutcome& outcome);
nlohmann::ordered_json training_json(const TrainingOutcome& outcome);

/// The folder for the files, for this process alone; of the same data and model it is written anew. Throws as
/// OutputFolder does.
OutputFolder folder_for_training(const std::filesystem::path& folder, const TrainingOutcome& outcome);
/// model.json, learned.toml (of a conservative model in R^n), history.csv, errors.csv (with held-out data), summaries,
/// plots; each whole or not at all. `note` says why there are no pictures.
std::vector<std::filesystem::path> write_training(const TrainingOutcome& outcome, const std::filesystem::path& folder,
                                                  std::string& note);

}  // namespace lagroid::app
