#pragma once
/// A run from a motion's first node to its last: the loop with checkpoints, a progress bar and interrupts.
///
///     RunResult result;
///     drive(motion, {.steps = 1000}, {.record = true}, result);
///
/// Requires a motion at its first node. The result has the trajectory, the ledger, what happened and how the run ended.
/// Errors: RunError where the checkpoint to go on from is of another run, or an event cannot be watched for;
/// OutputError where the folder cannot be used.

#include <lagroid/run/events/event.hpp>
#include <lagroid/run/motion/motion.hpp>
#include <lagroid/run/run_result.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid {

/// How far a run goes and what it leaves: [time] steps, [output] every and checkpoint, [[event]].
struct RunExtent {
  long steps = 0;
  long every = 1;               ///< each n-th node is recorded (and the last)
  long checkpoint = 0;          ///< steps from one checkpoint to the next; 0: by the clock
  std::string scene;            ///< to be kept, so that the run can be taken up
  std::vector<Event> events{};  ///< that are watched for
};

/// Options of a run.
struct RunContext {
  bool record = false;             ///< keep the trajectory
  bool progress = false;           ///< show a bar
  std::filesystem::path folder{};  ///< where checkpoints are kept; empty: nowhere
  bool resume = false;             ///< go on from the one kept there
  std::vector<Event> events{};     ///< watched for beside those of the extent that a scene gives: functions of programs
};

/// Runs the motion, which is at its first node, from there or from its checkpoint, and keeps checkpoints where
/// `context` names a folder. The result has its trajectory, its ledger and all else that reports need. A step that
/// fails, Ctrl-C or SIGTERM ends it with what was computed so far. Throws RunError where the checkpoint is of another
/// run or an event cannot be watched for (EventWatch), OutputError where the folder cannot be used.
void drive(Motion& motion, const RunExtent& extent, const RunContext& context, RunResult& result);

}  // namespace lagroid
