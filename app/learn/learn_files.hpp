#pragma once
/// What a training says and leaves.

#include "../spheres/model_file.hpp"
#include "learn.hpp"

#include <lagroid/run/output_folder.hpp>
#include <lagroid/solvers/learning/measures.hpp>
#include <lagroid/solvers/learning/train.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::app {

/// All that is known after a training.
struct Lesson {
  LearnOptions options;
  LearnedHamiltonian learned;
  learning::Trained trained;
  learning::Trajectories data;
  std::optional<learning::Trajectories> test;
  std::optional<learning::Measures> measures;  ///< on the latter
  std::vector<std::string> notes;
};

std::string lesson_text(const Lesson& lesson);
nlohmann::ordered_json lesson_json(const Lesson& lesson);

/// The folder for the files, for this process alone; of the same data and model it is written anew. Throws as
/// OutputFolder does.
OutputFolder folder_for_lesson(const std::filesystem::path& folder, const Lesson& lesson);
/// model.json, history.csv, errors.csv (with held-out data), summaries, plots; each whole or not at all. `note` says
/// why there are no pictures.
std::vector<std::filesystem::path> write_lesson(const Lesson& lesson, const std::filesystem::path& folder,
                                                std::string& note);

}  // namespace lagroid::app
