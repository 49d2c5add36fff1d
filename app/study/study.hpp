#pragma once
/// `lagroid study`: what accuracy costs a scene, by all methods that apply to it.

#include "../command/command.hpp"

#include <string>

namespace lagroid::app {

struct StudyCommandOptions : SceneOptions {
  std::string methods;    ///< patterns, separated by commas; empty: all
  std::string steps;      ///< sizes, separated by commas, or first:last:count; empty: found
  std::string reference;  ///< METHOD@STEP, or the study.json of an earlier study; empty: extrapolated
  double target = 1e-6;
  double longest = 0.25;  ///< s, a run
  double budget = 60;     ///< s, all of it
  int repetitions = 5;
  bool list = false;
  std::string out;
};

void add_study_options(CLI::App& command, StudyCommandOptions& options);

/// Returns the exit code. Throws SceneError for mistakes in the scene.
int study(const StudyCommandOptions& options);

}  // namespace lagroid::app
