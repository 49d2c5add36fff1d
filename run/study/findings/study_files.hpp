#pragma once
/// All that a study found, and its files: a page with figures, CSV and JSON.
///
///     std::string note;
///     const auto files = write_study(findings, "out/study", note);
///
/// Requires that the caller holds the folder (`folder_for_study`). Returns the files written; `note` has the reason
/// where there are no pictures. Errors: OutputError, FolderRefused.

#include <lagroid/run/study/survey.hpp>

#include <lagroid/run/files/output_folder.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid {

/// All that a study found.
struct Findings {
  std::string scene;    ///< the file
  std::string name;     ///< of the system or scene
  std::string command;  ///< that repeats it
  std::string machine;
  double end = 0;
  double target = 1e-6;
  std::string reference;
  double uncertainty = 0;
  std::vector<NamedVector> reference_state;
  std::vector<Measurement> runs;
  std::vector<LeftOut> left_out;
  double budget = 0;    ///< s
  int repetitions = 0;  ///< of each run that there was time for
  std::vector<Method> methods;
  bool interrupted = false;  ///< not all was measured
};

/// The folder for a study of that scene with those options, for this process alone; another budget or target makes a
/// better study of the same. `steps`: their sizes, where they are given. Throws as OutputFolder does.
OutputFolder folder_for_study(const std::filesystem::path& folder, const std::string& scene, const std::string& methods,
                              const std::vector<double>& steps, const std::string& reference, int repetitions);

/// What is recommended, a line each.
std::vector<std::string> recommendation(const Findings& findings);
/// What was not measured for want of time, a line each; none where all was.
std::vector<std::string> not_measured(const Findings& findings);
/// For the terminal.
std::string study_text(const Findings& findings);
std::string study_json(const Findings& findings);
/// study.csv, study.json, study.md, study.gp and, where gnuplot runs, study.svg and study.png; study.html holds all of
/// it. `note` gets the reason where there are no pictures.
std::vector<std::filesystem::path> write_study(const Findings& findings, const std::filesystem::path& folder,
                                               std::string& note);

}  // namespace lagroid
