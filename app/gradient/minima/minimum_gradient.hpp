#pragma once
/// `lagroid gradient` of a scene of `lagroid optimize`: how the least value and the point where it is taken depend on
/// the numbers of the problem.
///
///     lagroid gradient examples/optimisation/markers.toml --of minimum,minimiser --wrt data.B.0.0 --check
///
/// Rows are `minimum`, `minimiser` and one number of it (minimiser.0.2); columns are parameters.NAME and data.NAME, one
/// number by its row and column (data.A.3.4; of a symmetric matrix (4, 3) changes with it), places from zero. Errors:
/// SceneError; anything else is one line and an exit code.

#include "../../program.hpp"
#include "../../reading/scene_reader.hpp"
#include "../system_gradients.hpp"

#include <string>
#include <vector>

namespace lagroid::app {

/// What was asked for on the command line.
struct MinimumRequest {
  std::string scene;            ///< its file
  std::vector<std::string> of;  ///< empty: the minimum
  std::vector<std::string> by;  ///< empty: parameters, and data that are few
  bool check = false;
  bool json = false;
};

/// Prints the derivatives. Returns the exit code.
using ServeMinimum = int (*)(const Section& scene, const MinimumRequest& request);

/// Of a scene of `lagroid optimize`.
int gradient_of_minimum(const Section& scene, const MinimumRequest& request);

/// As the other one, with `minima` for scenes of `lagroid optimize`.
int gradient_program(int argc, char** argv, ProgramParts parts, const std::vector<AskGradient>& subjects,
                     ServeMinimum minima);

}  // namespace lagroid::app
