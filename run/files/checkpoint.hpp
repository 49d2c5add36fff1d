#pragma once
/// Checkpoints of a run: its scene, the rows recorded so far and its state, from which it goes on with the same bits.
///
/// A process that is killed loses what came after its last checkpoint, and nothing else.
///
///     Checkpoint checkpoint("out/run", 0);  // by the clock, not after a number of steps
///     checkpoint.begin(scene);
///     if (checkpoint.due(step)) checkpoint.keep(trajectory, state);
///
/// Requires that the caller holds the folder (OutputFolder). Errors: OutputError where the folder cannot be written,
/// RunError where there is nothing to go on with, or another build made it.

#include <lagroid/run/files/archive.hpp>
#include <lagroid/run/run_result.hpp>

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid {

/// The folder `checkpoint` of a run: its scene, the rows recorded so far in parts, and its state. Killed at any moment,
/// a run loses what came after its last checkpoint and nothing else: parts are only ever added, and the state, which
/// has their number, is replaced whole. Whoever makes one holds the run's folder (OutputFolder).
class Checkpoint {
 public:
  /// `steps`: after how many steps the next one is made; 0: when `seconds` have passed.
  Checkpoint(const std::filesystem::path& run, long steps);

  /// Begins anew, in place of what an earlier run left. Throws OutputError where the folder cannot be written.
  void begin(const std::string& scene);
  /// Takes away what an earlier run left: by one that keeps no checkpoints.
  void remove();
  /// What goes on with a run of this scene: a command or, of a program of one's own, that program.
  static std::string how_to_resume(std::string_view scene, const std::filesystem::path& run);
  /// The scene of a run. Throws RunError where there is none, or a program of one's own ran its system.
  static std::string scene_of(const std::filesystem::path& run);
  /// What stands there, whoever ran it. Throws RunError where there is nothing.
  static std::string text_of(const std::filesystem::path& run);
  /// Throws RunError where another build of lagroid made the checkpoint (machine.hpp), unless `other_build` takes that
  /// too, where another minor version did, or it cannot be read.
  static void require_this_build(const std::filesystem::path& run, bool other_build);
  /// Sets the rows, and returns the state. Throws RunError where there is none, or a damaged one.
  nlohmann::json restore(Trajectory& trajectory);
  /// The other builds that had a part in what was restored, the first one first.
  const std::vector<std::string>& other_builds() const { return others_; }

  bool due(long step);
  /// Adds the rows that are new since the last one.
  void keep(const Trajectory& trajectory, const nlohmann::json& state);

  static constexpr double seconds = 10;

 private:
  std::filesystem::path part(long k) const;

  std::filesystem::path folder_;
  long steps_;
  long parts_ = 0;
  std::size_t rows_ = 0;             ///< of the nodes, kept so far
  std::vector<std::size_t> values_;  ///< of each series, kept so far
  std::size_t scene_ = 0;            ///< the checksum of the scene's text
  std::vector<std::string> others_;  ///< builds before this one
  long until_look_ = 1;              ///< steps until the clock is looked at
  long stride_ = 1;
  std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_ = looked_;
};

}  // namespace lagroid
