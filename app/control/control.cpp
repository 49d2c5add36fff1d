#include "control.hpp"

#include "../command/written.hpp"
#include "../families/family.hpp"
#include "control_files.hpp"
#include "control_problem.hpp"
#include "results/row_words.hpp"

#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/progress.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

namespace lagroid::app {

namespace {

std::string listing() {
  std::string out;
  for (const ControlProblem* each : control_problems()) {
    out += fmt::format("{:<18} {}\n    state    {}\n    controls {}\n", each->name(), each->summary(),
                       fmt::join(each->states(), ", "), fmt::join(each->controls(), ", "));
    for (const Key& key : each->parameters())
      out += fmt::format("    {:<24} {}\n", "parameters." + key.name, listed(key));
  }
  return out;
}

/// What stands first in the lists that a message speaks of.
std::string what_first(const ControlResult& found) {
  if (const auto repeated = repeated_in_words(found); !repeated.empty()) return ": " + repeated.front();
  return found.report.worst.empty() ? "" : "; most of all " + in_words(found, found.report.worst.front());
}

/// The keys of what may help where a search found nothing.
std::string_view keys_of_starts(ControlStatus status) {
  switch (status) {
    case ControlStatus::infeasible:
    case ControlStatus::stagnated:
      return " (other starts: solver.starts, solver.seed)";
    case ControlStatus::not_converged:
      return " (other starts: solver.starts, solver.seed; iterations: solver.iterations)";
    default:
      return "";
  }
}

/// Why a search whose duration ran away found nothing; empty of any other.
std::string why_it_ran_away(const Section& scene, const ControlResult& found) {
  if (found.report.converged() || found.report.status == ControlStatus::infeasible || scene.has("phase") ||
      found.times.empty())
    return "";
  constexpr double much = 100;
  const double guess = scene.section_or_empty("horizon").number_or("duration", 0);
  const double reached = found.times.back() - found.times.front();
  if (!(guess > 0) || !(reached > much * guess)) return "";
  return fmt::format(
      "the cost falls as the duration grows, from a first guess of {:.4g} s to {:.3g} s, and nothing bounds it: let "
      "time cost something (parameters.cost = \"time\"), or give the duration (horizon.free = false)",
      guess, reached);
}

}  // namespace

void add_control_options(CLI::App& command, ControlCommandOptions& options) {
  command.add_option("scene", options.scene, "the scene, a TOML file");
  command.add_option("--set", options.overrides, "override a key: --set horizon.stages=200 (repeatable)")
      ->allow_extra_args(false);
  command.add_flag("--json", options.json, "print one JSON object and nothing else on standard output");
  command.add_option("--out", options.out, "write trajectory, plot and summary files into this folder");
  command.add_flag("--list", options.list, "list the problems with their states, controls and parameters");
}

int control(const ControlCommandOptions& options) {
  if (options.list) {
    print(listing());
    return 0;
  }
  if (options.scene.empty())
    return refuse(options.json, exit_bad_input, "invalid_command_line", "name a scene; see lagroid control --help");
  const Section scene = read_scene(options.scene, options.overrides);
  require_command(scene, "control");
  const ControlProblem& problem = control_problem(scene);
  std::optional<OutputFolder> folder;
  if (options.out) folder.emplace(folder_for_control(*options.out, scene));
  const InterruptGuard guard;
  ControlResult found;
  {
    Progress progress(std::string(problem.name()), 0, !options.json);
    found = problem.solve(scene, [&](int start) {
      progress.update(start);
      return !guard.interrupted();
    });
  }
  found.interrupted = guard.interrupted();
  const std::string ran_away = why_it_ran_away(scene, found);
  if (!ran_away.empty()) found.report.message = ran_away;
  std::string text = control_text(found);
  auto json = control_json(found);
  if (options.out) {
    std::string note;
    const auto files = write_control(found, *options.out, note);
    tell_written(files, note, text, json);
  } else {
    text += "  (no files written; --out DIR writes trajectory, plot and summary)\n";
  }
  print(options.json ? json_text(json) + "\n" : text);
  if (found.interrupted) {
    complain(fmt::format("{}: interrupted after {} iterations", options.scene, found.iterations));
    return exit_interrupted;
  }
  if (found.report.converged()) return code_after_writing(0, options.scene);
  std::string more;
  if (ran_away.empty()) more = fmt::format("{}{}", what_first(found), keys_of_starts(found.report.status));
  complain(fmt::format("{}: {}: {}{}", options.scene, to_string(found.report.status), found.report.message, more));
  return exit_failed;
}

}  // namespace lagroid::app
