#pragma once
/// What a sweep file says.

#include "design.hpp"
#include "members.hpp"

#include <lagroid/run/files/output_folder.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace lagroid::app {

/// [plot]: a quantity over one key or two; empty where the first ones are to be taken.
struct SweepPlot {
  std::string x;
  std::string y;
  std::string quantity;
};

struct SweepScene {
  std::string file;
  std::string text;   ///< of the sweep, with its overrides
  Section scene;      ///< what every member is but for its own numbers
  std::string given;  ///< the scene as it was written, before its accuracy was
  Design design;
  KeptColumns keep;
  SweepPlot plot;
  std::vector<std::string> notes;  ///< on how the scene came to be
  std::string engine;              ///< asked for: auto, scenes or lanes
  long part = 1;                   ///< members that are run, and written, together

  long parts() const { return (design.count() + part - 1) / part; }
  long first_of(long p) const { return p * part; }
  long count_of(long p) const { return std::min(part, design.count() - first_of(p)); }
};

/// The keys of a sweep.
Table sweep_table();

/// Reads SWEEP.toml and its scene; `scene = "FILE"` is seen from the sweep, or from the working folder where it is not
/// there. [scene] has the scene itself, or `file` and what is to differ from it. Where the scene asks for an accuracy,
/// method and step are still to be chosen. Throws SceneError.
SweepScene read_sweep(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// A sweep that was read on one rank, for the others: `scene` included, in which an accuracy has been replaced by the
/// method and step that were chosen.
std::string packed(const SweepScene& sweep);
/// Throws RunError where the other rank is of another build, unless `other_build`.
SweepScene unpacked(const std::string& text, bool other_build);

/// What must be the same for two sweeps to have the same results by one build.
OutputSource source_of(const SweepScene& sweep);

}  // namespace lagroid::app
