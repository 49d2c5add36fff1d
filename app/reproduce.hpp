#pragma once
/// `lagroid reproduce`: experiments, as report, tables, CSV and figures.

#include "command/command.hpp"

#include "experiments/learning/learning_hamiltonians.hpp"
#include "experiments/newton/newton_on_lie_groups.hpp"
#include "experiments/optimisation/accelerated_optimisation.hpp"

namespace lagroid::app {

struct ReproduceOptions {
  std::string name;  ///< of the one to carry out
  bool json = false;
  NewtonStudy newton;
  std::string newton_out = "out/newton-on-lie-groups";
  std::string time_out = "out/time-steps";
  int refinements = 7;
  AcceleratedStudy accelerated;
  std::string accelerated_out = "out/accelerated-optimization";
  int coarsest = 40;
  int map_refinements = 5;
  std::string maps_out = "out/constrained-maps";
  LearningStudy learning;
  std::string learning_out = "out/learning-hamiltonians";
  std::string poisson_out = "out/poisson";
  long poisson_steps = 10000;
  int poisson_paths = 50;
  long poisson_periods = 10000;
  std::string scaling_out = "out/sweep-scaling";
};

/// The subcommands of `reproduce`.
void add_reproductions(CLI::App& command, ReproduceOptions& options);

/// Carries out the one that was named; returns the exit code.
int reproduce(const ReproduceOptions& options);

}  // namespace lagroid::app
