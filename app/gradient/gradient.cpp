#include "computed_columns.hpp"
#include "fit/fit.hpp"
#include "gradient_table.hpp"
#include "system_gradients.hpp"
#include "uncertainty.hpp"

#include "../command/command.hpp"
#include "../families/family.hpp"
#include "../reading/data_set.hpp"
#include "../reading/kinds.hpp"

#include <lagroid/run/files/output_folder.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

namespace lagroid::app {

namespace {

struct GradientOptions : SceneOptions {
  std::vector<std::string> columns;
  std::vector<std::string> of{"final"};
  std::vector<std::string> by{"initial", "parameters"};
  bool check = false;
  std::vector<std::string> deviations;
  std::string covariance;
  Draws draws;
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

/// Adds notes of the subject, and one where the start is given by what is another momentum for other parameters.
void note_start(const Section& scene, const GradientSubject& subject, GradientTable& table) {
  table.notes.insert(table.notes.end(), subject.notes.begin(), subject.notes.end());
  const bool by_parameters = std::any_of(table.columns.begin(), table.columns.end(),
                                         [](const std::string& column) { return column.rfind("parameters.", 0) == 0; });
  if (!by_parameters || subject.begun_by) return;
  const Section initial = scene.section_or_empty("initial");
  for (const char* key : {"velocity", "rates", "spin"}) {
    if (!initial.has(key)) continue;
    table.notes.push_back(fmt::format(
        "the start is given by initial.{}: derivatives by parameters hold the momentum that it comes to, not the {} "
        "itself",
        key, key));
    return;
  }
}

/// Refuses scenes whose runs have no derivatives, of which this program knows no family.
void require_derivatives(const Section& scene) {
  if (!scene.has(keys::system)) return;
  const std::string system = scene.text(keys::system, "the name of a system");
  if (std::find(keys::on_spheres.begin(), keys::on_spheres.end(), system) != keys::on_spheres.end())
    scene.fail(keys::system, fmt::format("runs of \"{}\" have no derivatives", system));
}

/// Finds the scene's subject and calls use(subject, scene); what cannot be done is said in one line.
template <class Use>
int with_subject(const SceneOptions& options, const std::vector<AskGradient>& subjects, const Use& use) {
  const Section scene = read_scene(options.scene, options.overrides);
  require_derivatives(scene);
  for (const AskGradient ask : subjects) {
    try {
      const auto subject = ask(scene);
      if (!subject) continue;
      return use(*subject, scene);
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

int gradient_of_scene(const GradientOptions& options, const std::vector<AskGradient>& subjects) {
  return with_subject(options, subjects, [&](const GradientSubject& plain, const Section& scene) {
    const auto more = [&](const GradientSubject& of) { return with_columns(of, named_texts(options.columns)); };
    if (!options.deviations.empty() || !options.covariance.empty()) {
      if (plain.cost) throw GradientRefused("errors are carried along runs; a boundary value has a gradient alone");
      const InputErrors errors = options.covariance.empty() ? independent_errors(plain, options.deviations)
                                                            : fitted_errors(options.covariance);
      const GradientSubject subject = more(moved_to(plain, errors));
      Uncertainty found = uncertainty_of(subject, options.of, errors, options.draws);
      note_start(scene, subject, found.table);
      return report(options, found, found.table.failure);
    }
    if (options.draws.count > 0) throw GradientRefused("--draws are of errors: give --deviations or --covariance");
    const GradientSubject subject = more(plain);
    std::vector<std::string> by = options.by;
    std::vector<std::string> of = options.of;
    if (subject.cost && of == GradientOptions{}.of) of = {"cost"};
    if (by == GradientOptions{}.by) {
      if (subject.cost) by.front() = "boundary";
      if (subject.parameters.empty() && subject.refused.empty()) by.pop_back();
    }
    GradientTable table = differentiate(subject, of, by, options.check);
    note_start(scene, subject, table);
    return report(options, table, table.failure);
  });
}

struct FitCommandOptions : SceneOptions {
  std::vector<std::string> data;
  FitOptions fit;
  std::vector<std::string> columns, combinations, sigma, bounds;
  std::string residuals;
};

/// NAME=NUMBER, or NAME=LOW:HIGH.
double number_in(const std::string& word, std::size_t from, std::size_t to, const char* form) {
  double x = 0;
  const char* const end = word.data() + to;
  const auto read = std::from_chars(word.data() + from, end, x);
  if (read.ec != std::errc() || read.ptr != end || !std::isfinite(x))
    throw GradientRefused(fmt::format("{}: give {}", word, form));
  return x;
}
FitOptions fit_options(const FitCommandOptions& options) {
  FitOptions out = options.fit;
  out.combinations = named_texts(options.combinations);
  for (const std::string& word : options.sigma) {
    const std::size_t at = std::min(word.find('='), word.size());
    const double sigma = number_in(word, std::min(at + 1, word.size()), word.size(), "COLUMN=SIGMA");
    if (!(sigma > 0)) throw GradientRefused(fmt::format("{}: a sigma is positive", word));
    out.sigma[word.substr(0, at)] = sigma;
  }
  for (const std::string& word : options.bounds) {
    const std::size_t at = std::min(word.find('='), word.size()), colon = std::min(word.find(':', at), word.size());
    const char* const form = "NAME=LOW:HIGH";
    const double low = number_in(word, std::min(at + 1, word.size()), colon, form);
    const double high = number_in(word, std::min(colon + 1, word.size()), word.size(), form);
    if (!(low < high)) throw GradientRefused(fmt::format("{}: the first bound is the lower one", word));
    out.bounds[word.substr(0, at)] = {low, high};
  }
  return out;
}

int fit_of_scene(const FitCommandOptions& options, const std::vector<AskGradient>& subjects) {
  return with_subject(options, subjects, [&](const GradientSubject& plain, const Section&) {
    const GradientSubject subject = with_columns(plain, named_texts(options.columns));
    const Fit fit = fit_scene(subject, options.data, fit_options(options));
    if (fit.failure.empty() && !options.residuals.empty()) write_text(csv_of(fit), options.residuals);
    const int code = report(options, fit, fit.failure);
    return code == 0 && !fit.converged() ? exit_failed : code;
  });
}

int fit_program(int argc, char** argv, const std::vector<AskGradient>& subjects) {
  CLI::App app{"parameters and starts of a scene from measured columns", "lagroid fit"};
  FitCommandOptions options;
  add_scene_options(app, options);
  app.add_option("data", options.data, "CSV or HDF5 files with t and columns of the run; one for each run")->required();
  app.add_option("--wrt", options.fit.unknowns,
                 "what is fitted: initial.NAME or parameters.NAME, separated by commas (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--of", options.fit.columns, "columns of the data to use, separated by commas (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_columns_option(app, options.columns);
  app.add_option("--combination", options.combinations,
                 "NAME=EXPRESSION of initial.NAME and parameters.NAME: how well it is known; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--sigma", options.sigma,
                 "COLUMN=SIGMA, separated by commas: the standard deviations of its errors (default: 1)")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--bounds", options.bounds, "NAME=LOW:HIGH, separated by commas: what is fitted stays between")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--huber", options.fit.huber, "residuals beyond so many sigma weigh by their size, not its square")
      ->check(CLI::PositiveNumber);
  auto* starts = app.add_option("--starts", options.fit.starts, "guesses: the scene, and others drawn around it")
                     ->check(CLI::Range(1, 10'000));
  app.add_option("--spread", options.fit.spread, "of these, relative to each unknown (default 0.3)")
      ->check(CLI::PositiveNumber)
      ->needs(starts);
  app.add_option("--seed", options.fit.seed, "of these")->needs(starts);
  app.add_option("--residuals", options.residuals,
                 "a CSV file to write: what was measured and what the fitted run has");
  return command_line(app, argc, argv, options, [&] { return fit_of_scene(options, subjects); });
}

}  // namespace

int gradient_program(int argc, char** argv, ProgramParts parts, const std::vector<AskGradient>& subjects) {
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
         "of an event or of steps that vary; events: the times of all; of a boundary value cost "
         "(default: all at the end, cost)")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option(
         "--wrt", options.by,
         "initial.NAME, of a boundary value boundary.start or boundary.end, or parameters.NAME, separated by commas "
         "(default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_columns_option(app, options.columns);
  auto* deviations =
      app.add_option("--deviations", options.deviations,
                     "initial.NAME=SIGMA or parameters.NAME=SIGMA, separated by commas: what independent "
                     "errors of these standard deviations become");
  deviations->delimiter(',')->allow_extra_args(false)->excludes("--wrt");
  app.add_option("--covariance", options.covariance,
                 "what lagroid fit --json printed, as a file: what the errors of its solution become, from there")
      ->excludes("--wrt")
      ->excludes(deviations);
  app.add_option("--draws", options.draws.count,
                 "with one of these: compare with so many runs from starts drawn at random")
      ->check(CLI::Range(2L, 10'000'000L));
  app.add_option("--seed", options.draws.seed, "of those draws")->needs("--draws");
  app.add_flag("--check", options.check, "compare with extrapolated differences of runs");
  return command_line(app, argc, argv, options, [&] { return gradient_of_scene(options, subjects); });
}

}  // namespace lagroid::app
