#pragma once
/// What a sweep costs besides its members, measured; and what that makes of it on many machines.

#include "../sweep/work/ranks.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lagroid::app {

/// Constants of the model, s. Written and joined times are of parts of members with `columns` numbers each.
struct SweepCosts {
  static constexpr int columns = 20;

  int ranks = 0;
  double start = 0;       ///< until all ranks have the sweep
  double wait = 0;        ///< of a thread of another rank, from asking for a part to having it
  double hand = 0;        ///< of rank 0's processor, for each part
  double write_part = 0;  ///< a part into its file
  double write_member = 0;
  double join = 0;         ///< all parts into one file: at any rate,
  double join_part = 0;    ///< for each part,
  double join_member = 0;  ///< and for each member
};

/// A sweep of members that take `member` seconds each, on `workers` threads with `work` seconds of members for each of
/// them, cut into `parts` parts for each.
struct SweepJob {
  double workers = 1;
  double work = 0;
  double parts = 1;
  double member = 1;
};

/// Seconds that it takes by the model, and the share of them in which a thread works on members.
double sweep_seconds(const SweepCosts& costs, const SweepJob& job);
double sweep_efficiency(const SweepCosts& costs, const SweepJob& job);

/// Measures on all ranks; the result is that of rank 0. Needs two of them at least. Files are made in `folder`, and
/// removed. `start` is when this process began to join the others, in seconds of the steady clock.
SweepCosts measure_sweep(Ranks& ranks, double start, const std::filesystem::path& folder);

extern const std::vector<const char*> sweep_scaling_files;

/// report.md, model.csv and the figure. `note` says why there is no picture, where there is none.
std::vector<std::filesystem::path> write_sweep_scaling(const SweepCosts& costs, const std::string& command,
                                                       const std::filesystem::path& folder, std::string& note);

}  // namespace lagroid::app
