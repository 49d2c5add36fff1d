#pragma once
/// What a run leaves behind so that it can be taken up again.

#include "archive.hpp"
#include "run_result.hpp"

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace lagroid::app {

/// The folder `checkpoint` of a run: its scene, the rows recorded so far in parts, and its state. Killed at any moment,
/// a run loses what came after its last checkpoint and nothing else: parts are only ever added, and the state, which
/// says how many of them count, is replaced whole.
class Checkpoint {
 public:
  /// `steps`: after how many steps the next one is made; 0: when `seconds` have passed.
  /// Throws OutputError where another run is at work in the folder.
  Checkpoint(const std::filesystem::path& run, long steps);
  Checkpoint(const Checkpoint&) = delete;
  Checkpoint& operator=(const Checkpoint&) = delete;
  ~Checkpoint();

  /// Begins anew. Throws OutputError where the folder cannot be written.
  void begin(const std::string& scene);
  /// Of an earlier run, where the folder is used for one that keeps none.
  static void remove(const std::filesystem::path& run);
  /// The scene of a run that is taken up. Throws RunError where there is none.
  static std::string scene_of(const std::filesystem::path& run);
  /// Sets the rows, and returns the state. Throws RunError where there is none, or a damaged one.
  nlohmann::json restore(Trajectory& trajectory);

  bool due(long step) const;
  /// Adds the rows that are new since the last one.
  void keep(const Trajectory& trajectory, const nlohmann::json& state);

  static constexpr double seconds = 10;

 private:
  std::filesystem::path part(long k) const;

  std::filesystem::path folder_;
  int lock_ = -1;
  long steps_;
  long parts_ = 0;
  std::size_t rows_ = 0;             ///< of the nodes, kept so far
  std::vector<std::size_t> values_;  ///< of each series, kept so far
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace lagroid::app
