#pragma once
/// What a scene of `lagroid optimize` says.

#include "../keys/key.hpp"

#include <lagroid/solvers/optimisation/minimise.hpp>
#include <lagroid/systems/optimisation/instances.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace lagroid::app {

struct OptimisationScene {
  std::string problem;
  optimisation::Instance instance;
  optimisation::Point start;
  std::unique_ptr<optimisation::DescentMethod> method;
  optimisation::Stopping stopping;
  std::optional<double> least;    ///< where `reference` or `gap` asked for it
  std::optional<double> penalty;  ///< the weight, with constraint = "penalty"
};

/// The keys of such a scene.
Table optimisation_table();

/// Reads all of it; files are seen from the folder of `file`. Throws SceneError.
OptimisationScene read_optimisation(const Section& scene, const std::filesystem::path& file);

}  // namespace lagroid::app
