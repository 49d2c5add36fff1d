#pragma once
/// The files of a sweep: what the same sweep leaves again, to the byte, on any threads and ranks.

#include "sweep_scene.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// All members of a sweep.
struct SweepResult {
  std::string engine;  ///< by which they were run
  SweepPart members;

  long failed() const;
};

extern const std::vector<const char*> sweep_files;

std::string sweep_text(const SweepScene& sweep, const SweepResult& result);
nlohmann::ordered_json sweep_json(const SweepScene& sweep, const SweepResult& result);

/// sweep.h5; members.csv where there are not too many; summary.json, summary.txt; and where one or two keys vary, or
/// [plot] says so, plot.gp, plot.svg and plot.png, of which a missing gnuplot costs the pictures: `note` says so.
std::vector<std::filesystem::path> write_sweep(const SweepScene& sweep, const SweepResult& result,
                                               const std::filesystem::path& folder, std::string& note);

}  // namespace lagroid::app
