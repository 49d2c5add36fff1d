#pragma once
/// The functions that a scene can ask to minimise.

#include "../keys/key.hpp"

#include <lagroid/systems/optimisation/instances.hpp>

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace lagroid::app {

struct ProblemEntry {
  std::string_view name;
  std::string_view summary;
  std::vector<Key> data;        ///< keys of [data]
  std::vector<Key> parameters;  ///< keys of [parameters]
  /// Reads [data] and [parameters] of `scene`; files are seen from `folder`.
  optimisation::Instance (*read)(const Section& scene, const std::filesystem::path& folder);
};

std::span<const ProblemEntry> problems();

/// The one that `problem` names.
optimisation::Instance read_problem(const Section& scene, const std::filesystem::path& folder);

}  // namespace lagroid::app
