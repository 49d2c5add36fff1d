#include "reproduce.hpp"

#include "output_folder.hpp"
#include "progress.hpp"
#include "reproductions/newton_report.hpp"
#include "reproductions/time_steps.hpp"
#include "shell.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <utility>

namespace lagroid::app {

namespace {

constexpr const char* newton_name = "newton-on-lie-groups";
constexpr const char* time_name = "time-steps";

/// Shares of steps solved, by example and method.
nlohmann::ordered_json solved(const NewtonFindings& findings) {
  nlohmann::ordered_json out;
  for (const auto example : newton_examples)
    for (const auto method : newton_methods)
      out[fmt::format("example {}", number_of(example))][name_of(method)] = solved_share(findings, example, method);
  return out;
}

int reproduce_newton(const ReproduceOptions& options, bool json) {
  const NewtonStudy& study = options.newton;
  if (study.smallest > study.largest)
    return refuse(json, exit_bad_input, "invalid_command_line",
                  fmt::format("--smallest {} is above --largest {}", study.smallest, study.largest));
  try {
    require_writable(options.newton_out, newton_report_files);
  } catch (const OutputError& error) {
    return refuse(json, exit_bad_input, "invalid_command_line", error.what());
  }
  const auto start = std::chrono::steady_clock::now();
  NewtonFindings findings;
  findings.study = study;
  findings.command =
      fmt::format("./lagroid reproduce {} --smallest {} --largest {} --seeds {} --first-seed {} --out {}", newton_name,
                  study.smallest, study.largest, study.seeds, study.first_seed, quoted(options.newton_out));
  {
    Progress progress(newton_name, 2L * study.seeds * (study.largest - study.smallest + 1), !json);
    findings.cells = run_newton_study(study, [&](long done, long) { progress.update(done); });
  }
  findings.times = time_newton_iterations(study.largest);
  findings.integrators = measure_implicit_integrators();
  std::string note;
  const auto files = write_newton_report(findings, options.newton_out, note);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  nlohmann::ordered_json result;
  result["status"] = "done";
  result["steps"] = findings.cells.size() / newton_methods.size();
  result["seconds"] = seconds;
  result["solved"] = solved(findings);
  for (const auto& file : files) result["files"].push_back(file.string());
  if (!note.empty()) result["notes"].push_back("no pictures: " + note);
  if (json) {
    print(result.dump(2) + "\n");
    return 0;
  }
  std::string text = fmt::format("{}: {} steps by {} methods in {:.3g} s\n", newton_name, result["steps"].get<long>(),
                                 newton_methods.size(), seconds);
  for (const auto& [example, shares] : result["solved"].items()) {
    text += fmt::format("  {}, solved to 1e-13 (1 + h)\n", example);
    for (const auto& [method, share] : shares.items())
      text += fmt::format("    {:<20} {:6.2f} %\n", method, 100 * share.get<double>());
  }
  if (!note.empty()) text += fmt::format("  note: no pictures: {}\n", note);
  for (const auto& file : files) text += fmt::format("  wrote {}\n", file.string());
  print(text);
  return 0;
}

int reproduce_time_steps(const ReproduceOptions& options, bool json) {
  try {
    require_writable(options.time_out, time_report_files);
  } catch (const OutputError& error) {
    return refuse(json, exit_bad_input, "invalid_command_line", error.what());
  }
  const auto start = std::chrono::steady_clock::now();
  TimeFindings findings;
  {
    Progress progress(time_name, 100, !json);
    findings = run_time_study(options.refinements, [&](long done, long all) { progress.update(100 * done / all); });
  }
  std::string note;
  const auto files = write_time_report(findings,
                                       fmt::format("./lagroid reproduce {} --refinements {} --out {}", time_name,
                                                   options.refinements, quoted(options.time_out)),
                                       options.time_out, note);
  nlohmann::ordered_json result;
  result["status"] = "done";
  result["runs"] = findings.runs.size();
  result["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const auto& run : findings.runs)
    if (run.method != "fixed")
      result["gain_at_equal_cost"][run.problem][run.method] = gain_at_equal_cost(findings, run.problem, run.method);
  for (const auto& file : files) result["files"].push_back(file.string());
  if (!note.empty()) result["notes"].push_back("no pictures: " + note);
  if (json) {
    print(result.dump(2) + "\n");
    return 0;
  }
  std::string text =
      fmt::format("{}: {} runs in {:.3g} s\n", time_name, findings.runs.size(), result["seconds"].get<double>());
  for (const auto& [problem, gains] : result["gain_at_equal_cost"].items()) {
    text += fmt::format("  {}, error of fixed steps of order 2 over theirs at equal cost\n", problem);
    for (const auto& [method, gain] : gains.items())
      text += fmt::format("    {:<20} {:8.3g}\n", method, gain.get<double>());
  }
  if (!note.empty()) text += fmt::format("  note: no pictures: {}\n", note);
  for (const auto& file : files) text += fmt::format("  wrote {}\n", file.string());
  print(text);
  return 0;
}

}  // namespace

void add_reproductions(CLI::App& command, ReproduceOptions& options, bool& json) {
  command.require_subcommand(1);
  CLI::App* time = command.add_subcommand(
      time_name, "fixed, adaptive and controlled steps, composed and split ones: error against time and evaluations");
  time->add_option("--out", options.time_out, "the folder for report.md, CSV and figures")->capture_default_str();
  time->add_option("--refinements", options.refinements, "how many step sizes a method runs with")
      ->check(CLI::Range(2, 12))
      ->capture_default_str();
  time->add_flag("--json", json, "print one JSON object and nothing else on standard output");
  time->callback([&options] { options.name = time_name; });
  CLI::App* newton = command.add_subcommand(
      newton_name, "Owren and Welfert, section 5: Newton, fixed point, Ceres and the path on O(N), and what they cost");
  newton->add_option("--out", options.newton_out, "the folder for report.md, tables, CSV and figures")
      ->capture_default_str();
  newton->add_option("--smallest", options.newton.smallest, "the least N")
      ->check(CLI::Range(2, 50))
      ->capture_default_str();
  newton->add_option("--largest", options.newton.largest, "the greatest N; large ones take long (N^6)")
      ->check(CLI::Range(2, 50))
      ->capture_default_str();
  newton->add_option("--seeds", options.newton.seeds, "how many random starting points for each N")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  newton->add_option("--first-seed", options.newton.first_seed, "the first of their seeds")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  newton->add_flag("--json", json, "print one JSON object and nothing else on standard output");
  newton->callback([&options] { options.name = newton_name; });
}

int reproduce(const ReproduceOptions& options, bool json) {
  return options.name == time_name ? reproduce_time_steps(options, json) : reproduce_newton(options, json);
}

}  // namespace lagroid::app
