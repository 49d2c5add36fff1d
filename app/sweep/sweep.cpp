#include "sweep.hpp"

#include "../command/command_of.hpp"
#include "../command/written.hpp"
#include "../reading/scene_reader.hpp"
#include "../study/accuracy.hpp"
#include "lanes.hpp"
#include "sweep_files.hpp"
#include "sweep_folder.hpp"
#include "work/ranks.hpp"
#include "work/schedule.hpp"

#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/files/nesting.hpp>
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/reports/clock.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/progress.hpp>
#include <lagroid/run/run_result.hpp>
#include <lagroid/solvers/ensemble/tasks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>

namespace lagroid::app {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// What rank 0 knows before all else.
struct Plan {
  SweepScene sweep;
  std::unique_ptr<SweepFolder> folder;
};

/// Runs a little of the scene as it is written: what is wrong with it, and names that it does not know, are told now.
void try_out(const SweepScene& sweep, const SweepOptions& options) {
  const Section file = read_scene(options.scene, options.overrides);
  const SweepPart tried = try_scene(file, sweep.scene, sweep.keep);
  if (sweep.engine == "lanes")
    if (const std::string why = why_no_lanes(sweep.scene, sweep.design, sweep.keep); !why.empty())
      file.section("run", "").fail("engine", fmt::format("no lanes here: {}; leave it out", why));
  if (tried.find("final/t") == nullptr) return;
  const std::vector<std::string> keys = sweep.design.columns();
  for (const auto& [key, column] :
       {std::pair("x", sweep.plot.x), std::pair("y", sweep.plot.y), std::pair("quantity", sweep.plot.quantity)})
    if (!column.empty() && column != "run/cost" && tried.find(column) == nullptr &&
        std::find(keys.begin(), keys.end(), column) == keys.end())
      file.section("plot", "").fail(key, fmt::format("there is no column \"{}\" in members.csv", column));
}

/// Reads everything and makes sure that it can be run and written.
Plan prepare(const SweepOptions& options) {
  Plan plan{read_sweep(options.scene, options.overrides), nullptr};
  SweepScene& sweep = plan.sweep;
  require_writable(options.out, sweep_files);
  const bool accurate = sweep.scene.has("accuracy");
  if (!accurate) try_out(sweep, options);
  plan.folder = std::make_unique<SweepFolder>(options.out, sweep, options.other_build);
  if (plan.folder->finished()) return plan;
  if (plan.folder->begun()) {
    plan.folder->restore(sweep);
  } else if (accurate) {
    // Chosen once, for the scene as it is written, and kept: all members have the same method and step.
    AccuracyChoice choice = choose_by_accuracy(sweep.scene);
    sweep.scene = std::move(choice.scene);
    sweep.notes = std::move(choice.notes);
    try_out(sweep, options);
  }
  plan.folder->begin(sweep);
  return plan;
}

/// The engine: lanes where they are asked for or may be taken.
std::unique_ptr<MemberRunner> runner_of(const SweepScene& sweep) {
  if (sweep.engine != "scenes")
    if (auto lanes = lane_runner(sweep.scene, sweep.design, sweep.keep)) return lanes;
  return scene_runner(sweep.scene, sweep.design, sweep.keep);
}

/// Runs a part of the sweep, and keeps it. False where an interrupt came before it was finished.
std::function<bool(long)> worker(const SweepScene& sweep, const std::string& out) {
  return [&sweep, runner = std::shared_ptr<MemberRunner>(runner_of(sweep)), files = PartFiles(out)](long p) {
    const auto part = runner->run(sweep.first_of(p), sweep.count_of(p));
    if (part) files.keep(p, *part);
    return part.has_value();
  };
}

/// The exit code where so many members failed.
int told_of_failed(const SweepOptions& options, long failed, long members) {
  if (failed == 0) return 0;
  complain(fmt::format("{}: {} of {} members failed; their rows say why", options.scene, failed, members));
  return exit_failed;
}

int tell_finished(const SweepOptions& options) {
  const std::filesystem::path folder = options.out;
  long failed = 0;
  long members = 0;
  try {
    const auto json = read_json(contents(folder / "summary.json").value_or("")).value_or(nullptr);
    json.at("failed").get_to(failed);
    json.at("members").get_to(members);
  } catch (const nlohmann::json::exception&) {
    throw RunError(fmt::format("--out {}: summary.json is damaged; remove the folder and run the same command again",
                               options.out));
  }
  const std::string text = contents(folder / (options.json ? "summary.json" : "summary.txt")).value_or("");
  print(options.json ? text : text + fmt::format("  (finished before; the files are in {})\n", options.out));
  return told_of_failed(options, failed, members);
}

/// Joins the parts, writes the files, tells what was found. Returns the exit code.
int conclude(Plan& plan, const SweepOptions& options, const std::string& took) {
  const SweepResult result{std::string(runner_of(plan.sweep)->name()), plan.folder->joined(plan.sweep)};
  std::string note;
  std::string text = sweep_text(plan.sweep, result);
  auto json = sweep_json(plan.sweep, result);
  const auto files = write_sweep(plan.sweep, result, options.out, note);
  plan.folder->finish();
  text += took;
  tell_written(files, note, text, json);
  print(options.json ? json_text(json) + "\n" : text);
  return code_after_writing(told_of_failed(options, result.failed(), result.members.count()), options.scene);
}

/// Rank 0.
int lead(Ranks& ranks, const SweepOptions& options) {
  const auto start = Clock::now();
  std::optional<Plan> plan;
  std::vector<long> missing;
  std::string told;
  try {
    plan.emplace(prepare(options));
    if (!plan->folder->finished()) {
      missing = plan->folder->missing(plan->sweep);
      if (ranks.size() > 1) told = packed(plan->sweep);
    }
  } catch (...) {
    ranks.broadcast("");
    throw;
  }
  if (plan->folder->finished()) {
    ranks.broadcast("");
    return tell_finished(options);
  }
  ranks.broadcast(told);
  const long parts = plan->sweep.parts();
  ScheduleOutcome outcome;
  {
    Progress progress("sweep", parts, !options.json);
    const SchedulingOptions schedule{
        .threads = options.threads,
        .progress = [&](long done) { progress.update(parts - long(missing.size()) + done); },
        .interrupted = InterruptGuard::interrupted};
    outcome = for_each_part(ranks, missing, schedule, worker(plan->sweep, options.out));
  }
  const long left = long(plan->folder->missing(plan->sweep).size());
  if (!outcome.failure.empty())
    throw OutputError(fmt::format("{}{}; {} of {} parts are kept, and the same command goes on from them",
                                  ranks.size() > 1 ? fmt::format("rank {}: ", outcome.failed_rank) : "",
                                  outcome.failure, parts - left, parts));
  if (left > 0)
    return refuse(options.json, exit_interrupted, interrupted_status,
                  fmt::format("{}: interrupted; {} of {} parts are kept in {}, and the same command goes on from them",
                              options.scene, parts - left, parts, options.out));
  const int threads = options.threads > 0 ? options.threads : available_threads();
  const std::string took =
      fmt::format("  took      {} on {} thread{}{}{}\n", duration(seconds_since(start)), threads,
                  threads == 1 ? "" : "s", ranks.size() > 1 ? fmt::format(" of each of {} ranks", ranks.size()) : "",
                  long(missing.size()) < parts ? ", after what was kept from before" : "");
  return conclude(*plan, options, took);
}

/// Any other rank.
int follow(Ranks& ranks, const SweepOptions& options) {
  const std::string text = ranks.broadcast("");
  if (text.empty()) return 0;
  SweepScene sweep;
  std::function<bool(long)> work;
  try {
    sweep = unpacked(text, options.other_build);
    work = worker(sweep, options.out);
  } catch (const std::exception& error) {
    // Rank 0 tells it.
    work = [why = std::string(error.what())](long) -> bool { throw std::runtime_error(why); };
  }
  for_each_part(ranks, {}, {.threads = options.threads, .interrupted = InterruptGuard::interrupted}, work);
  return 0;
}

}  // namespace

void add_sweep_options(CLI::App& command, SweepOptions& options) {
  command.add_option("sweep", options.scene, "what varies, and what is kept: a TOML file")->required();
  command.add_option("--out", options.out, "write results into this folder; go on there if they were broken off")
      ->required();
  command.add_option("--threads", options.threads, "of each process; all that are available by default")
      ->check(CLI::Range(1, 4096));
  command.add_option("--set", options.overrides, "override a key: --set design.count=100 (repeatable)")
      ->allow_extra_args(false);
  command.add_flag("--other-build", options.other_build,
                   "go on with parts that another build of lagroid ran; the same bits are not promised then");
  command.add_flag("--json", options.json, "print one JSON object and nothing else on standard output");
}

int sweep(const SweepOptions& options) {
  try {
    const auto ranks = join_ranks();
    const InterruptGuard guard;
    return ranks->rank() == 0 ? lead(*ranks, options) : follow(*ranks, options);
  } catch (const FolderRefused&) {
    throw;
  } catch (const OutputError& error) {
    return refuse(options.json, exit_failed, "output_failed", error.what());
  } catch (const RunError& error) {
    return refuse(options.json, exit_bad_input, "invalid_run", error.what());
  } catch (const std::bad_alloc&) {
    return refuse(options.json, exit_failed, "out_of_memory",
                  fmt::format("{}: out of memory; have fewer members, or keep less of each", options.scene));
  }
}

ProgramCommand sweep_command() {
  ProgramCommand command =
      command_of("sweep", "run many members of one scene, on all threads or under mpirun (see docs/sweeps.md)",
                 add_sweep_options, sweep);
  command.run_scene = [](const SceneOptions& scene, const std::optional<std::string>& out) {
    if (!out)
      return refuse(scene.json, exit_bad_input, "invalid_command_line",
                    scene.scene + ": is a sweep, whose members are written into a folder: give --out DIR");
    SweepOptions options;
    static_cast<SceneOptions&>(options) = scene;
    options.out = *out;
    return sweep(options);
  };
  return command;
}

}  // namespace lagroid::app
