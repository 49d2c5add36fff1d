#include <lagroid/run/events/event_watch.hpp>
#include <lagroid/run/files/archive.hpp>
#include <lagroid/run/files/checkpoint.hpp>
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/motion/drive.hpp>
#include <lagroid/run/motion/integrate_nodes.hpp>
#include <lagroid/run/reports/progress.hpp>
#include <lagroid/solvers/step/step_messages.hpp>

#include <fmt/format.h>

#include <algorithm>
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

/// All that a run goes on from.
struct Kept {
  WatchedMotion& watched;
  Judge& judge;
  EventWatch* events;  ///< or null

  void serialize(Archive& archive) {
    archive.numbers("motion", [&](NumberArchive& numbers) { watched.motion().serialize(numbers); });
    archive("judge", judge);
    archive("watched", watched);
    if (events != nullptr) archive("events", *events);
  }
};

void serialize(Archive& archive, Kept& run, RunResult& result, Clock& clock) {
  archive("clock", clock);
  archive("steps", result.steps);
  archive("iterations", result.iterations);
  archive("most iterations", result.ledger.most_iterations);
  archive("run", run);
}

void restore(Checkpoint& checkpoint, Trajectory& rows, Kept& run, RunResult& result, Clock& clock,
             const RunContext& context) {
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
  result.system = motion.name();
  result.method = description(motion.traits());
  result.steps_asked = extent.steps;
  const Observables& first = motion.look();
  result.initial = first.endpoint();
  Judge judge(first);
  Recorder recorder(first);
  WatchedMotion watched(motion, &judge, context.record ? &recorder : nullptr, extent.every);
  std::optional<EventWatch> events;
  if (!extent.events.empty()) events.emplace(extent.events, motion);
  Kept run{watched, judge, events ? &*events : nullptr};
  std::optional<Checkpoint> checkpoint;
  if (!context.folder.empty()) checkpoint.emplace(context.folder, extent.checkpoint);
  const auto keep = [&] {
    if (!checkpoint) return;
    Archive archive;
    serialize(archive, run, result, clock);
    try {
      checkpoint->keep(recorder.trajectory(), archive.fields());
    } catch (const OutputError& error) {  // a full disk: what is computed is worth more
      result.output_error = error.what();
      checkpoint.reset();
    }
  };
  watched.observe();
  if (context.resume) {
    restore(*checkpoint, recorder.trajectory(), run, result, clock, context);
    if (result.steps > extent.steps)
      throw RunError(fmt::format("{} steps are no more than the run has already, which are {}; ask for more to go on",
                                 extent.steps, result.steps));
  } else {
    if (checkpoint) checkpoint->begin(extent.scene);
    keep();
  }
  const auto count = [&](const StepReport& report) {
    result.iterations += report.iterations;
    result.ledger.most_iterations = std::max(result.ledger.most_iterations, report.iterations);
  };
  using Why = IntegrationEnd::Why;
  IntegrationEnd end;
  bool interrupted = false;
  {
    Progress progress(result.system, extent.steps, context.progress);
    const InterruptGuard guard;
    const auto goes_on = [&](const StepReport& report) {
      count(report);
      ++result.steps;
      progress.update(result.steps);
      if (guard.interrupted() && result.steps < extent.steps) return false;
      if (checkpoint && checkpoint->due(result.steps)) keep();
      return true;
    };
    const long steps = extent.steps - result.steps;
    end = events ? integrate_nodes(watched, *events, steps, goes_on) : integrate_nodes(watched, steps, goes_on);
    // In the middle of a step, too, which was then not made.
    interrupted = (end.why == Why::stopped || end.why == Why::failed) && guard.interrupted();
  }
  if (end.why == Why::whole || interrupted) keep();  // what failed is counted, but not kept: taken up, it fails again
  if (interrupted) {
    result.status = interrupted_status;
    result.message = fmt::format(
        "interrupted after step {} of {}; what was computed is kept{}", result.steps, extent.steps,
        checkpoint ? fmt::format(", and {} goes on", Checkpoint::how_to_resume(extent.scene, context.folder))
                   : std::string());
  } else if (end.why == Why::failed) {
    count(end.report);
    result.status = std::string(to_string(end.report.status));
    result.residual = end.report.residual;
    result.message = motion.failure(end.report, result.steps + 1);
  } else if (end.why == Why::event) {
    if (end.report.converged()) count(end.report);
    ++result.steps;
    if (end.report.converged()) {
      result.notes.push_back(events->reason());
    } else {
      result.status = std::string(to_string(end.report.status));
      result.message = events->reason();
    }
  } else if (end.why == Why::not_finite) {
    count(end.report);
    ++result.steps;
    result.status = std::string(to_string(SolveStatus::not_finite));
    result.message = fmt::format(
        "step {}: time, energy or constraints are no finite numbers any more; use a smaller step", result.steps);
  }
  if (!watched.observe_last() && result.converged()) {
    result.status = std::string(to_string(SolveStatus::not_finite));
    result.message = "energy or constraints are no finite numbers at the end; use a smaller or a larger step";
  }
  judge.report(result.ledger);
  if (context.record) result.trajectory = std::move(recorder.trajectory());
  result.final = end.why == Why::event && end.report.converged() ? events->end().endpoint() : motion.look().endpoint();
  motion.describe(result);
  if (events) events->report(result);
  result.ledger.mean_iterations = result.steps > 0 ? double(result.iterations) / double(result.steps) : 0;
  result.seconds = clock.seconds();
}

}  // namespace lagroid
