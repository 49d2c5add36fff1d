#include <lagroid/run/files/archive.hpp>
#include <lagroid/run/files/checkpoint.hpp>
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/followed_run.hpp>
#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/motion/drive.hpp>
#include <lagroid/run/reports/progress.hpp>

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <stdexcept>

namespace lagroid {

namespace {

/// The time that a run has taken, its earlier parts included.
class Clock {
 public:
  double seconds() const {
    return before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  void serialize(Archive& archive) {
    double passed = seconds();
    archive("seconds", passed);
    if (archive.restoring()) before_ = passed;
  }

 private:
  double before_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void serialize(Archive& archive, FollowedRun& run, RunResult& result, Clock& clock) {
  archive("clock", clock);
  archive("steps", result.steps);
  archive("iterations", result.iterations);
  archive("most iterations", result.ledger.most_iterations);
  archive("run", run);
}

void restore(Checkpoint& checkpoint, FollowedRun& run, RunResult& result, Clock& clock, const RunContext& context) {
  Trajectory& rows = run.trajectory();
  rows.time.clear();
  for (Columns& series : rows.series) series.values.clear();
  const auto refuse = [&](const char* of) {
    return RunError(
        fmt::format("{}: its checkpoint is of another {}; run the scene again", context.folder.string(), of));
  };
  Archive archive(checkpoint.restore(rows));
  for (const std::string& build : checkpoint.other_builds())
    result.notes.push_back("goes on from another build (" + build + "), without the promise of the same bits");
  try {
    serialize(archive, run, result, clock);
  } catch (const nlohmann::json::exception&) {
    throw refuse("lagroid");
  } catch (const std::invalid_argument&) {
    throw refuse("scene");
  } catch (const std::out_of_range&) {
    throw refuse("scene");
  }
}

}  // namespace

void drive(Motion& motion, const RunExtent& extent, const RunContext& context, RunResult& result) {
  Clock clock;
  FollowedRun run(motion, extent, context.record, result);
  std::optional<Checkpoint> checkpoint;
  if (!context.folder.empty()) checkpoint.emplace(context.folder, extent.checkpoint);
  const auto keep = [&] {
    if (!checkpoint) return;
    Archive archive;
    serialize(archive, run, result, clock);
    try {
      checkpoint->keep(run.trajectory(), archive.fields());
    } catch (const OutputError& error) {  // a full disk: what is computed is worth more
      result.output_error = error.what();
      checkpoint.reset();
    }
  };
  run.begin();
  if (context.resume) {
    restore(*checkpoint, run, result, clock, context);
    if (result.steps > extent.steps)
      throw RunError(fmt::format("{} steps are no more than the run has already, which are {}; ask for more to go on",
                                 extent.steps, result.steps));
  } else {
    if (checkpoint) checkpoint->begin(extent.scene);
    keep();
  }
  using Why = IntegrationEnd::Why;
  bool interrupted = false;
  {
    Progress progress(result.system, extent.steps, context.progress);
    const InterruptGuard guard;
    run.advance(extent.steps, [&](const StepReport&) {
      progress.update(result.steps);
      if (guard.interrupted() && result.steps < extent.steps) return false;
      if (checkpoint && checkpoint->due(result.steps)) keep();
      return true;
    });
    // In the middle of a step, too, which was then not made.
    interrupted = (run.end().why == Why::stopped || run.end().why == Why::failed) && guard.interrupted();
  }
  // What failed is counted, but not kept: taken up, it fails again.
  if (run.end().why == Why::whole || interrupted) keep();
  if (interrupted) {
    result.status = interrupted_status;
    result.message = fmt::format(
        "interrupted after step {} of {}; what was computed is kept{}", result.steps, extent.steps,
        checkpoint ? fmt::format(", and {} goes on", Checkpoint::how_to_resume(extent.scene, context.folder))
                   : std::string());
  } else {
    run.tell_end();
  }
  run.finish();
  result.seconds = clock.seconds();
}

}  // namespace lagroid
