#pragma once
/// Independent parts of work on all threads of all ranks, as they come free.

#include "ranks.hpp"

#include <functional>
#include <span>
#include <string>

namespace lagroid::app {

/// How parts are handed out, and who is told.
struct SchedulingOptions {
  int threads = 0;                                     ///< of each rank; 0: all that it may use
  std::function<void(long parts)> progress = nullptr;  ///< on rank 0, from time to time: how many are finished
  std::function<bool()> interrupted = nullptr;         ///< asked by each rank; no parts are begun after it
};

struct ScheduleOutcome {
  bool finished = false;       ///< every part
  std::string failure;         ///< what a part threw
  int failed_rank = 0;         ///< where
  double seconds_waiting = 0;  ///< of all threads of all ranks, between asking for a part and having it
  double seconds_handing = 0;  ///< processor time that the handing out took
};

/// Calls work(part) for each of `parts` (known to rank 0) once, on any rank, from several threads at a time. `work`
/// returns false where an interrupt came before the part was finished; an exception ends the schedule, too. Called by
/// all ranks; all return when all have ended, with the outcome on rank 0. Rank 0 hands parts out from the calling
/// thread, in their order, while its own threads work; who is idle asks, and nobody spins.
ScheduleOutcome for_each_part(Ranks& ranks, std::span<const long> parts, const SchedulingOptions& schedule,
                              const std::function<bool(long)>& work);

}  // namespace lagroid::app
