#pragma once
/// The folder of a sweep while it goes on: finished parts are files of their own, so that an interruption costs no more
/// than the parts that were being computed.

#include "sweep_scene.hpp"
#include "work/part.hpp"

#include <lagroid/run/files/output_folder.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <vector>

namespace lagroid::app {

/// The parts in it. Any process may keep parts of its own.
class PartFiles {
 public:
  explicit PartFiles(const std::filesystem::path& folder) : folder_(folder / "parts") {}

  /// Throws OutputError.
  void keep(long part, const SweepPart& members) const;
  /// None where there is none, or a damaged one.
  std::optional<SweepPart> read(long part) const;
  bool has(long part) const;
  void remove(long part) const;
  /// Whether there is a file of parts.
  bool any() const;
  /// The parts, and their folder where nothing else is in it.
  void remove_all() const;

 private:
  std::filesystem::path file(long part) const;

  std::filesystem::path folder_;
};

/// The folder as a whole, which one process holds.
class SweepFolder {
 public:
  /// Opens the folder for this process alone. Throws as OutputFolder does, and RunError where the folder holds parts of
  /// a sweep but no record of which one, where that record is damaged, and where another build of lagroid wrote them
  /// (its bits may be others), unless `other_build` allows that.
  SweepFolder(const std::filesystem::path& folder, const SweepScene& sweep, bool other_build = false);

  /// Whether an earlier command began this sweep, and whether one finished it.
  bool begun() const { return kept_.has_value(); }
  bool finished() const;
  /// Gives `sweep` the scene and the notes of the command that began it.
  void restore(SweepScene& sweep) const;
  /// Throws OutputError.
  void begin(const SweepScene& sweep);
  /// Which parts are still to be run.
  std::vector<long> missing(const SweepScene& sweep) const;
  /// All parts, one after the other. Removes damaged ones and then throws RunError.
  SweepPart joined(const SweepScene& sweep) const;
  /// To be called when the results are written.
  void finish();

 private:
  std::filesystem::path file() const { return folder_ / "sweep.cbor"; }

  std::filesystem::path folder_;
  OutputFolder held_;
  PartFiles parts_;
  std::optional<nlohmann::json> kept_;
};

}  // namespace lagroid::app
