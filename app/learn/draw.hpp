#pragma once
/// `lagroid trajectories`: trajectories of a pendulum chain in a file, to learn from.

#include "../command/command.hpp"

#include <optional>
#include <string>
#include <vector>

namespace lagroid::app {

struct DrawOptions {
  int links = 1;
  std::vector<double> masses;   ///< one each, or one for all
  std::vector<double> lengths;  ///< likewise
  double gravity = 1;
  int count = 500;
  int points = 5;
  double duration = 0.1;
  double noise = 0;
  unsigned seed = 0;
  std::string out;
  bool json = false;
};

void add_draw_options(CLI::App& command, DrawOptions& options);

/// Returns the exit code. Throws OutputError.
int draw(const DrawOptions& options);

}  // namespace lagroid::app
