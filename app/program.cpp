#include "program.hpp"

#include "cite/cite.hpp"
#include "command/written.hpp"
#include "listing.hpp"
#include "schema/schema.hpp"
#include "study/run_scene.hpp"
#include "study/study.hpp"
#include "view.hpp"

#include <lagroid/core/version.hpp>
#include <lagroid/run/files/checkpoint.hpp>
#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/files/output.hpp>
#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/process.hpp>
#include <lagroid/run/reports/report.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace {

struct RunOptions : SceneOptions {
  std::optional<std::string> out;
  bool other_build = false;
  std::string covariance;
  std::vector<std::string> deviations;
  bool carries_errors() const { return !covariance.empty() || !deviations.empty(); }
};

/// The scene of a run that is taken up, of which only the number of steps may change.
Section kept_scene(const std::string& folder, const std::vector<std::string>& overrides) {
  refuse_found_control(folder);
  const std::string text = Checkpoint::scene_of(folder);
  for (const std::string& given : overrides)
    if (!given.starts_with("time.steps="))
      throw RunError(fmt::format("--set {}: a run goes on as it began; only time.steps can be set", given));
  return parse_scene(text, folder + "/checkpoint/scene.toml", overrides);
}

/// Carries out a scene that is no motion by the command that is made for it.
int hand_over(std::string_view name, const RunOptions& options, const std::vector<ProgramCommand>& commands) {
  const auto command = std::ranges::find(commands, name, &ProgramCommand::name);
  if (command == commands.end() || !command->run_scene)
    return refuse(
        options.json, exit_bad_input, "invalid_command_line",
        fmt::format("{}: is carried out by lagroid {}, which this program does not have", options.scene, name));
  return command->run_scene(options, options.out);
}

/// NAME-check or NAME-gradient beside NAME: what they hold of every system takes long to compile, and whoever only runs
/// scenes need not wait for it.
std::string program_beside(const std::string& command) {
  return std::filesystem::canonical("/proc/self/exe").string() + "-" + command;
}
int refuse_without(const std::string& beside, const std::string& status, const std::string& what, int error,
                   bool json) {
  return refuse(json, exit_bad_input, status,
                fmt::format("{}: {}; it holds the {}, and was not built: build the target lagroid_{}, of a program of "
                            "your own with the component of find_package that makes it, or install a package that has "
                            "it",
                            beside, std::strerror(error), what, beside.substr(beside.rfind('-') + 1)));
}
constexpr const char* no_gradients = "no_gradients";
constexpr const char* derivatives_of_runs = "derivatives of runs";

/// Hands over to such a program.
int hand_over_beside(const std::string& command, const std::string& status, const std::string& what, int argc,
                     char** argv) {
  const std::string beside = program_beside(command);
  ::execv(beside.c_str(), argv);
  return refuse_without(beside, status, what, errno, asks_for_json(argc, argv));
}

/// What errors of the start and of parameters become along the run: the table that lagroid gradient has of it. Nothing,
/// and `code` is set, where there is none, which was told.
std::optional<std::string> errors_of_run(const RunOptions& options, int& code) {
  const std::string beside = program_beside("gradient");
  std::vector<std::string> words{beside, options.scene};
  for (const std::string& each : options.overrides) words.insert(words.end(), {"--set", each});
  if (!options.covariance.empty()) words.insert(words.end(), {"--covariance", options.covariance});
  if (!options.deviations.empty())
    words.insert(words.end(), {"--deviations", fmt::format("{}", fmt::join(options.deviations, ","))});
  std::string file = (std::filesystem::temp_directory_path() / "lagroid-XXXXXX").string();
  const int opened = ::mkstemp(file.data());
  if (opened < 0) throw RunError(fmt::format("{}: {}", file, std::strerror(errno)));
  ::close(opened);
  std::optional<std::string> table;
  try {
    code = run_process(words, {.out = file});
    if (code == 0) table = contents(file);
  } catch (const std::system_error& error) {
    code = refuse_without(beside, no_gradients, derivatives_of_runs, error.code().value(), false);
  }
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  if (table && !options.covariance.empty())
    table =
        fmt::format("from the numbers that were fitted ({}) in place of the scene's:\n{}", options.covariance, *table);
  return table;
}

/// Runs the scene, or takes up the run in the folder `out`.
int run(const RunOptions& options, bool resume, const std::vector<ProgramCommand>& commands) {
  RunResult result;
  std::optional<OutputFolder> folder;
  std::optional<std::string> errors;
  try {
    const Section scene =
        resume ? kept_scene(*options.out, options.overrides) : read_scene(options.scene, options.overrides);
    if (const auto command = family_of(scene).command(); command != "run") {
      if (options.carries_errors())
        throw RunError(fmt::format("{}: errors are carried along motions; this is carried out by lagroid {}",
                                   options.scene, command));
      return hand_over(command, options, commands);
    }
    if (int code = 0; options.carries_errors() && !(errors = errors_of_run(options, code))) return code;
    if (options.out) folder.emplace(resume ? folder_of_run(*options.out) : folder_for_run(*options.out, scene.whole()));
    if (resume) Checkpoint::require_this_build(*options.out, options.other_build);
    result = run_scene(scene, {.record = options.out.has_value(),
                               .progress = !options.json,
                               .folder = options.out.value_or(""),
                               .resume = resume});
  } catch (const RunError& error) {
    return refuse(options.json, exit_bad_input, "invalid_run", error.what());
  }
  std::string report;
  if (options.out) {
    for (const auto& file : write_outputs_if_possible(result, *options.out))
      report += fmt::format("  wrote {}\n", file.string());
    if (errors) {
      const std::filesystem::path file = std::filesystem::path(*options.out) / "errors.txt";
      write_text(*errors, file);
      report += fmt::format("  wrote {}\n", file.string());
    }
  } else {
    report = "  (no files written; --out DIR writes trajectory, plot and summary)\n";
  }
  if (errors) report += "\n" + *errors;
  print(options.json ? json_report(result) + "\n" : text_report(result) + report);
  if (!result.converged()) complain(fmt::format("{}: {}", resume ? *options.out : options.scene, result.message));
  if (!result.output_error.empty()) complain(result.output_error);
  if (result.interrupted() && result.output_error.empty()) return exit_interrupted;
  if (!result.converged() || !result.output_error.empty()) return exit_failed;
  return code_after_writing(0, resume ? *options.out : options.scene);
}

/// Writes something from a run's folder: `make` returns the files.
int from_run(const std::function<std::vector<std::filesystem::path>()>& make) {
  try {
    std::string report;
    for (const auto& file : make()) report += fmt::format("  wrote {}\n", file.string());
    print(report);
    return 0;
  } catch (const RunError& error) {
    return refuse(false, InterruptGuard::interrupted() ? exit_interrupted : exit_bad_input, "invalid_run",
                  error.what());
  }
}

}  // namespace

int program(int argc, char** argv, ProgramParts parts) {
  use_families(std::move(parts.families));
  use_systems(std::move(parts.systems));
  const std::vector<ProgramCommand>& commands = parts.commands;
  CLI::App app{"lagroid: discrete mechanics on Lie groupoids", "lagroid"};
  app.set_version_flag("--version", LAGROID_VERSION);
  RunOptions options;
  CLI::App* run_command = app.add_subcommand("run", "run a scene (see docs/scenes.md)");
  add_scene_options(*run_command, options);
  run_command->add_option("--out", options.out, "write trajectory, plot and summary files into this folder");
  auto* json = run_command->get_option("--json");
  auto* covariance = run_command->add_option("--covariance", options.covariance,
                                             "what lagroid fit --json printed, as a file: what the errors of its "
                                             "solution become at the end, by lagroid gradient --covariance");
  auto* deviations = run_command->add_option("--deviations", options.deviations,
                                             "initial.NAME=SIGMA or parameters.NAME=SIGMA, separated by commas: the "
                                             "same of independent errors, by lagroid gradient --deviations");
  covariance->excludes(json);
  deviations->delimiter(',')->allow_extra_args(false)->excludes(json)->excludes(covariance);
  CLI::App* resume_command =
      app.add_subcommand("resume", "go on with a run that was broken off, or with a finished one");
  resume_command->add_option("run", options.out, "the folder that lagroid run --out wrote")->required();
  resume_command->add_option("--set", options.overrides, "time.steps=N: go on to so many steps")
      ->allow_extra_args(false);
  resume_command->add_flag("--other-build", options.other_build,
                           "go on with the work of another build of lagroid; the same bits are not promised then");
  resume_command->add_flag("--json", options.json, "print one JSON object and nothing else on standard output");
  ViewOptions view;
  CLI::App* view_command = app.add_subcommand(
      "view", "write view.html into a run's folder: bodies in motion, curves and ledger, for any browser");
  view_command->add_option("run", view.run, "the folder that lagroid run --out wrote")->required();
  view_command->add_option("--rows", view.most_rows, "of the trajectory, at most (default 4000)")
      ->check(CLI::Range(2L, 1'000'000L));
  PlotOptions plot;
  CLI::App* plot_command =
      app.add_subcommand("plot", "draw plot.svg and plot.png of a run anew, by its plot.gp, which may be edited");
  plot_command->add_option("run", plot.run, "the folder that lagroid run --out wrote")->required();
  plot_command->add_flag("--own-script", plot.own_script, "draw by a plot.gp that was edited: it can run anything");
  CLI::App* check_command =
      app.add_subcommand("check", "test every law that applies to a scene's system: lagroid check --help");
  check_command->set_help_flag();
  check_command->prefix_command();
  CLI::App* gradient_command = app.add_subcommand(
      "gradient", "exact derivatives of a run by its start and its parameters: lagroid gradient --help");
  gradient_command->set_help_flag();
  gradient_command->prefix_command();
  CLI::App* fit_command =
      app.add_subcommand("fit", "parameters and starts of a scene from measured columns: lagroid fit --help");
  fit_command->set_help_flag();
  fit_command->prefix_command();
  CLI::App* list_command = app.add_subcommand("list", "list the systems a scene can name");
  std::string listed_system;
  list_command->add_option("system", listed_system, "one of them alone");
  list_command->add_flag("--json", options.json, "print one JSON array and nothing else on standard output");
  SchemaOptions schema_options;
  CLI::App* schema_command =
      app.add_subcommand("schema", "print a JSON Schema of scenes, for editors (see docs/scenes.md)");
  add_schema_options(*schema_command, schema_options);
  StudyCommandOptions study_options;
  CLI::App* study_command = app.add_subcommand(
      "study", "what accuracy costs a scene: error against time and evaluations, by all methods that apply");
  add_study_options(*study_command, study_options);
  CiteOptions cite_options;
  CLI::App* cite_command = app.add_subcommand("cite", "how to cite the program, and the papers that a scene rests on");
  add_cite_options(*cite_command, cite_options);
  std::vector<CLI::App*> added;
  for (const ProgramCommand& command : commands) added.push_back(command.add(app));
  app.require_subcommand(0, 1);
  return command_line(app, argc, argv, options, [&] {
    if (list_command->parsed()) {
      print(options.json ? json_listing(listed_system) : text_listing(listed_system));
      return 0;
    }
    if (schema_command->parsed()) return schema(schema_options);
    if (check_command->parsed()) return hand_over_beside("check", "no_laws", "laws", argc - 1, argv + 1);
    if (gradient_command->parsed() || fit_command->parsed())
      return hand_over_beside("gradient", no_gradients, derivatives_of_runs, argc - 1, argv + 1);
    if (run_command->parsed()) return run(options, false, commands);
    if (resume_command->parsed()) return run(options, true, commands);
    if (view_command->parsed()) return from_run([&] { return std::vector{write_view(view)}; });
    if (plot_command->parsed()) return from_run([&] { return draw_plots(plot); });
    if (study_command->parsed()) {
      static_cast<SceneOptions&>(options) = study_options;
      return study(study_options);
    }
    if (cite_command->parsed()) {
      options.json = cite_options.json;
      return cite(cite_options);
    }
    std::string names;
    for (std::size_t i = 0; i < commands.size(); ++i) {
      if (added[i]->parsed()) return commands[i].run(options);
      names += ", " + commands[i].name;
    }
    return refuse(
        options.json, exit_bad_input, "invalid_command_line",
        fmt::format("name a command: run, resume, view, plot, study, check, list, schema{} or cite; see lagroid --help",
                    names));
  });
}

}  // namespace lagroid::app
