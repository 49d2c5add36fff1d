#include <lagroid/run/checkpoint.hpp>
#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/output_folder.hpp>
#include <lagroid/run/progress.hpp>
#include <lagroid/run/stepped_run.hpp>

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
  void persist(Archive& archive) {
    double passed = seconds();
    archive("seconds", passed);
    if (archive.restoring()) before_ = passed;
  }

 private:
  double before_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void persist(Archive& archive, SteppedRun& run, RunResult& result, Clock& clock) {
  archive("clock", clock);
  archive("steps", result.steps);
  archive("iterations", result.iterations);
  archive("most iterations", result.ledger.most_iterations);
  archive("run", run);
}

void restore(Checkpoint& checkpoint, SteppedRun& run, RunResult& result, Clock& clock, const RunContext& context) {
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
    persist(archive, run, result, clock);
  } catch (const nlohmann::json::exception&) {
    throw refuse("lagroid");
  } catch (const std::invalid_argument&) {
    throw refuse("scene");
  } catch (const std::out_of_range&) {
    throw refuse("scene");
  }
}

}  // namespace

void drive(SteppedRun& run, const Pace& pace, const RunContext& context, RunResult& result) {
  Clock clock;
  result.steps_asked = pace.steps;
  std::optional<Checkpoint> checkpoint;
  if (!context.folder.empty()) checkpoint.emplace(context.folder, pace.checkpoint);
  const auto keep = [&] {
    if (!checkpoint) return;
    Archive archive;
    persist(archive, run, result, clock);
    try {
      checkpoint->keep(run.trajectory(), archive.fields());
    } catch (const OutputError& error) {  // a full disk: what is computed is worth more
      result.output_error = error.what();
      checkpoint.reset();
    }
  };
  run.observe(0);
  StepReport failed;  // counted, but not kept: taken up, the run comes to it again
  bool whole = true;
  if (context.resume) {
    restore(*checkpoint, run, result, clock, context);
    if (result.steps > pace.steps)
      throw RunError(fmt::format("--set time.steps={}: the run has {} steps already", pace.steps, result.steps));
  } else {
    if (checkpoint) checkpoint->begin(pace.scene);
    keep();
  }
  {
    Progress progress(result.system, pace.steps, context.progress);
    const InterruptGuard guard;
    for (long k = result.steps + 1; k <= pace.steps; ++k) {
      const auto interrupt = [&](long done) {
        result.status = interrupted_status;
        result.message = fmt::format(
            "interrupted after step {} of {}; what was computed is kept{}", done, pace.steps,
            checkpoint ? fmt::format(", and lagroid resume {} goes on", context.folder.string()) : std::string());
      };
      const StepReport report = run.advance();
      if (!report.converged() && guard.interrupted()) {  // in the middle of a step, which was not made
        interrupt(k - 1);
        break;
      }
      if (!report.converged()) {
        failed = report;
        whole = false;
        result.status = std::string(to_string(report.status));
        result.residual = report.residual;
        result.message = run.failure(report, k);
        break;
      }
      result.iterations += report.iterations;
      result.ledger.most_iterations = std::max(result.ledger.most_iterations, report.iterations);
      result.steps = k;
      if (!run.observe(k)) {
        whole = false;
        result.status = std::string(to_string(SolveStatus::not_finite));
        result.message =
            fmt::format("step {}: time, energy or constraints are no finite numbers any more; use a smaller step", k);
        break;
      }
      progress.update(k);
      if (guard.interrupted() && k < pace.steps) {
        interrupt(k);
        break;
      }
      if (checkpoint && checkpoint->due(k)) keep();
    }
  }
  if (whole) keep();
  result.iterations += failed.iterations;
  result.ledger.most_iterations = std::max(result.ledger.most_iterations, failed.iterations);
  result.ledger.mean_iterations = result.steps > 0 ? double(result.iterations) / double(result.steps) : 0;
  result.seconds = clock.seconds();
}

}  // namespace lagroid
