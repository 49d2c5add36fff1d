#include "columns/computed_columns.hpp"
#include "fit/fit_command.hpp"
#include "fit/fit_files.hpp"
#include "gradient_table.hpp"
#include "minima/minimum_gradient.hpp"
#include "system_gradients.hpp"
#include "uncertainty.hpp"

#include "../command/command.hpp"
#include "../command/written.hpp"
#include "../families/family.hpp"
#include "../reading/data_set.hpp"
#include "../reading/kinds.hpp"

#include <lagroid/run/files/output_folder.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace lagroid::app {

namespace {

struct GradientOptions : SceneOptions {
  std::vector<std::string> columns;
  std::vector<std::string> of;  ///< empty: all at the end, the cost, the minimum
  std::vector<std::string> by;  ///< empty: all
  bool check = false;
  std::vector<std::string> deviations;
  std::string covariance;
  Draws draws;
  StateBudget budget;
};

/// --column of both commands.
void add_columns_option(CLI::App& app, std::vector<std::string>& columns) {
  app.add_option("--column", columns,
                 "NAME=EXPRESSION of columns and parameters.NAME: one more column of the run; may be repeated")
      ->allow_extra_args(false);
}
std::vector<NamedText> named_texts(const std::vector<std::string>& words) {
  std::vector<NamedText> out;
  for (const std::string& word : words) out.push_back(named_text(word));
  return out;
}

/// Prints what was found, and how it went.
template <class Found> int report(const SceneOptions& options, const Found& found, const std::string& failure) {
  if (!options.json && !failure.empty()) {
    complain(fmt::format("{}: {}", options.scene, failure));
    return exit_failed;
  }
  print(options.json ? json_of(found) + "\n" : text_of(found));
  return failure.empty() ? 0 : exit_failed;
}

/// Adds notes of the subject.
void add_notes(const GradientSubject& subject, GradientTable& table) {
  table.notes.insert(table.notes.end(), subject.notes.begin(), subject.notes.end());
}

/// Refuses scenes on spheres where this program has not their family.
void require_family(const Section& scene) {
  if (!scene.has(keys::system)) return;
  const std::string system = scene.text(keys::system, "the name of a system");
  const auto knows = [&](const auto& names) { return std::find(names.begin(), names.end(), system) != names.end(); };
  if (knows(keys::on_spheres) && !knows(family_of(scene).names()))
    scene.fail(keys::system, fmt::format("this program has no derivatives of runs of \"{}\"", system));
}

/// Finds the scene's subject and calls use(subject); what cannot be done is said in one line.
template <class Use>
int with_subject(const SceneOptions& options, const Section& scene, const std::vector<AskGradient>& subjects,
                 const Use& use) {
  require_family(scene);
  if (scene.has(keys::control))
    scene.fail(keys::control,
               "there are no derivatives of what lagroid control finds; its costates (lagroid control "
               "--out) say how the cost changes with the states");
  for (const AskGradient& ask : subjects) {
    try {
      const auto subject = ask(scene);
      if (!subject) continue;
      return use(*subject);
    } catch (const GradientRefused& refusal) {
      return refuse(options.json, exit_bad_input, "invalid_command_line", refusal.what());
    } catch (const DataError& refusal) {
      return refuse(options.json, exit_bad_input, "invalid_data", refusal.what());
    } catch (const std::invalid_argument& refusal) {
      return refuse(options.json, exit_bad_input, "no_derivative", refusal.what());
    }
  }
  if (scene.has(keys::bodies)) scene.fail(keys::bodies, "this program has no derivatives of runs of bodies");
  return refuse(
      options.json, exit_bad_input, "no_derivative",
      fmt::format("{}: there are no derivatives of runs of {}", options.scene, module_of_scene(scene).name()));
}

/// Of a scene of `lagroid optimize`, whose minimum is asked for by other words.
int gradient_of_optimum(const GradientOptions& options, const Section& scene, ServeMinimum minima) {
  if (minima == nullptr) scene.fail(keys::optimisation, "this program has no derivatives of minima");
  for (const auto& [is_given, option] :
       {std::pair(!options.columns.empty(), "--column"), std::pair(!options.deviations.empty(), "--deviations"),
        std::pair(!options.covariance.empty(), "--covariance"), std::pair(options.draws.count > 0, "--draws"),
        std::pair(options.budget.states > 0, "--states")})
    if (is_given)
      return refuse(options.json, exit_bad_input, "invalid_command_line",
                    fmt::format("{}: is of runs; of a minimum there are derivatives alone", option));
  return minima(scene, {options.scene, options.of, options.by, options.check, options.json});
}

std::vector<std::string> rows_asked(const GradientOptions& options, const GradientSubject& subject) {
  if (!options.of.empty()) return options.of;
  return {subject.cost ? "cost" : "final"};
}
std::vector<std::string> columns_asked(const GradientOptions& options, const GradientSubject& subject) {
  if (!options.by.empty()) return options.by;
  std::vector<std::string> out{subject.cost ? "boundary" : "initial"};
  if (!subject.parameters.empty() || !subject.refused.empty()) out.emplace_back("parameters");
  return out;
}

int gradient_of_scene(const GradientOptions& options, const std::vector<AskGradient>& subjects, ServeMinimum minima) {
  const Section scene = read_scene(options.scene, options.overrides);
  if (scene.has(keys::optimisation)) return gradient_of_optimum(options, scene, minima);
  return with_subject(options, scene, subjects, [&](const GradientSubject& plain) {
    const auto more = [&](const GradientSubject& of) { return with_columns(of, named_texts(options.columns)); };
    if (!options.deviations.empty() || !options.covariance.empty()) {
      if (plain.cost) throw GradientRefused("errors are carried along runs; a boundary value has a gradient alone");
      const InputErrors errors = options.covariance.empty() ? independent_errors(plain, options.deviations)
                                                            : fitted_errors(options.covariance);
      const GradientSubject subject = more(moved_to(plain, errors));
      Uncertainty found = uncertainty_of(subject, rows_asked(options, subject), errors, options.draws);
      add_notes(subject, found.table);
      return report(options, found, found.table.failure);
    }
    if (options.draws.count > 0) throw GradientRefused("--draws are of errors: give --deviations or --covariance");
    const GradientSubject subject = more(plain);
    GradientTable table = differentiate(subject, rows_asked(options, subject), columns_asked(options, subject),
                                        options.check, options.budget);
    add_notes(subject, table);
    const int code = report(options, table, table.failure);
    return code == 0 && !table.contradicted.empty() ? exit_failed : code;
  });
}

/// The same of a fit with its files.
int report_with_files(const FitCommandOptions& options, const Fit& fit) {
  std::string note, text = text_of(fit);
  auto json = nlohmann::ordered_json::parse(json_of(fit));
  tell_written(write_fit(fit, *options.out, note), note, text, json);
  print(options.json ? json.dump(2) + "\n" : text);
  return 0;
}

int fit_of_scene(const FitCommandOptions& options, const std::vector<AskGradient>& subjects) {
  const Section scene = read_scene(options.scene, options.overrides);
  if (scene.has(keys::optimisation))
    scene.fail(keys::optimisation,
               "is no motion that measured columns could tell of; lagroid gradient has derivatives of its minimum");
  return with_subject(options, scene, subjects, [&](const GradientSubject& plain) {
    require_place_of_residuals(options);
    const GradientSubject subject = with_columns(plain, named_texts(options.columns));
    std::optional<OutputFolder> folder;
    if (options.out) folder.emplace(folder_for_fit(*options.out, scene, options.data));
    const Fit fit = fit_scene(subject, options.data, fit_options(options));
    const int code =
        fit.failure.empty() && options.out ? report_with_files(options, fit) : report(options, fit, fit.failure);
    if (fit.failure.empty() && !options.residuals.empty()) write_text(csv_of(fit), options.residuals);
    return code == 0 && !fit.converged() ? exit_failed : code;
  });
}

int fit_program(int argc, char** argv, const std::vector<AskGradient>& subjects) {
  CLI::App app{"parameters and starts of a scene from measured columns", "lagroid fit"};
  FitCommandOptions options;
  add_scene_options(app, options);
  add_fit_options(app, options);
  add_columns_option(app, options.columns);
  return command_line(app, argc, argv, options, [&] { return fit_of_scene(options, subjects); });
}

}  // namespace

int gradient_program(int argc, char** argv, ProgramParts parts, const std::vector<AskGradient>& subjects) {
  return gradient_program(argc, argv, std::move(parts), subjects, nullptr);
}

int gradient_program(int argc, char** argv, ProgramParts parts, const std::vector<AskGradient>& subjects,
                     ServeMinimum minima) {
  use_families(std::move(parts.families));
  use_systems(std::move(parts.systems));
  // As lagroid hands over to it (program.cpp), and as `lagroid-gradient fit`.
  for (int i = 0; i < std::min(argc, 2); ++i)
    if (argv[i] == std::string_view("fit")) return fit_program(argc - i, argv + i, subjects);
  CLI::App app{"exact derivatives of a scene's run, by its start and its parameters", "lagroid gradient"};
  GradientOptions options;
  add_scene_options(app, options);
  app.add_option(
         "--of", options.of,
         "final.NAME, node.K.NAME, integral.NAME or, of events, event.NAME.K.COLUMN, separated by commas: "
         "position, momentum, configuration, of Poisson systems state, energy, Casimirs, a column of them, the time t "
         "of an event or of steps that vary; events: the times of all; of a boundary value cost; of a scene of "
         "optimize minimum and minimiser (default: all at the end, cost, minimum)")
      ->delimiter(',')
      ->transform(named())
      ->allow_extra_args(false);
  app.add_option(
         "--wrt", options.by,
         "initial.NAME, of a boundary value boundary.start or boundary.end, or parameters.NAME, of a minimum data.NAME "
         "too, separated by commas (default: all)")
      ->delimiter(',')
      ->transform(named())
      ->allow_extra_args(false);
  add_columns_option(app, options.columns);
  auto* deviations =
      app.add_option("--deviations", options.deviations,
                     "initial.NAME=SIGMA or parameters.NAME=SIGMA, separated by commas: what independent "
                     "errors of these standard deviations become");
  deviations->delimiter(',')->allow_extra_args(false)->excludes("--wrt");
  auto* covariance =
      app.add_option("--covariance", options.covariance,
                     "what lagroid fit --json printed, as a file: what the errors of its solution become, from there");
  covariance->transform(named())->excludes("--wrt")->excludes(deviations);
  app.add_option("--draws", options.draws.count,
                 "with one of these: compare with so many runs from starts drawn at random")
      ->check(CLI::Range(2L, 10'000'000L));
  app.add_option("--seed", options.draws.seed, "of those draws")->needs("--draws");
  app.add_option(
         "--states", options.budget.states,
         "go backward, with at most so many states kept on the way (default: forward or backward as is cheaper, "
         "with 2 sqrt(steps)); the fewer, the more often steps are solved, with 1 half their number squared")
      ->check(CLI::Range(1L, 1'000'000'000L))
      ->excludes(deviations)
      ->excludes(covariance);
  app.add_flag("--check", options.check,
               "compare with extrapolated differences of runs; ends with 3 where they contradict")
      ->excludes(deviations)
      ->excludes(covariance);
  return command_line(app, argc, argv, options, [&] { return gradient_of_scene(options, subjects, minima); });
}

}  // namespace lagroid::app
