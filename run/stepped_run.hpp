#pragma once
/// Runs of steps: from the first node to the last, with checkpoints, progress and interrupts.

#include <lagroid/core/quantity.hpp>
#include <lagroid/run/archive.hpp>
#include <lagroid/run/run_result.hpp>
#include <lagroid/solvers/step_solver.hpp>

#include <filesystem>
#include <functional>
#include <string>

namespace lagroid {

/// Sees every point of a run, in order, beside its recorder; may be null.
template <class Sys> using Observer = std::function<void(const TrajectoryPoint<Sys>&)>;

/// How far a run goes and what it leaves: [time] steps, [output] every and checkpoint.
struct Pace {
  long steps = 0;
  long every = 1;       ///< each n-th node is recorded (and the last)
  long checkpoint = 0;  ///< steps from one checkpoint to the next; 0: by the clock
  std::string scene;    ///< to be kept, so that the run can be taken up
};

/// What is asked of a run.
struct RunContext {
  bool record = false;             ///< keep the trajectory
  bool progress = false;           ///< show a bar
  std::filesystem::path folder{};  ///< where checkpoints are kept; empty: nowhere
  bool resume = false;             ///< go on from the one kept there
};

/// What is run step by step.
class SteppedRun {
 public:
  virtual ~SteppedRun() = default;
  virtual StepReport advance() = 0;
  /// Why a step did not converge, and what to do.
  virtual std::string failure(const StepReport& report, long step) const = 0;
  /// Sees the node after the given step, 0 being the first node; false where its numbers are not finite.
  virtual bool observe(long step) = 0;
  /// The rows recorded so far.
  virtual Trajectory& trajectory() = 0;
  /// Visits all else that the run goes on from.
  virtual void persist(Archive& archive) = 0;
};

/// Runs it, from its first node or from its checkpoint, and keeps checkpoints where `context` names a folder. A step
/// that fails, Ctrl-C or SIGTERM ends it with what was computed so far. Throws RunError where the checkpoint is of
/// another run, OutputError where the folder cannot be used.
void drive(SteppedRun& run, const Pace& pace, const RunContext& context, RunResult& result);

}  // namespace lagroid
