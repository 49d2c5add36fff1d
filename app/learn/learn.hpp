#pragma once
/// `lagroid learn`: fits a Hamiltonian on (T*S^2)^k or R^2n to trajectories.

#include "../command/command.hpp"

#include <limits>
#include <optional>
#include <string>

namespace lagroid::app {

struct LearnOptions {
  std::string data;
  std::string model = "network:8";
  bool dissipation = false;
  std::optional<std::string> integrator;  ///< else of order four, as the data's space calls it
  int points = 0;                         ///< of the pieces that trajectories are cut into; zero: none
  int substeps = 2;
  double noise = 0;
  std::optional<std::string> test;
  double test_noise = 0;
  std::optional<double> validation;  ///< else a fifth with noise, nothing without
  int starts = 4;
  int iterations = 100;
  unsigned seed = 1;
  double enough = 0;
  double seconds = std::numeric_limits<double>::infinity();
  std::optional<std::string> out;
  bool json = false;
};

void add_learn_options(CLI::App& command, LearnOptions& options);

/// Returns the exit code. Throws OutputError.
int learn(const LearnOptions& options);

}  // namespace lagroid::app
