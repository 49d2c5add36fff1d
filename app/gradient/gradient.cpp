#include "gradient_table.hpp"
#include "system_gradients.hpp"
#include "uncertainty.hpp"

#include "../command/command.hpp"
#include "../families/family.hpp"

#include <fmt/format.h>

#include <utility>

namespace lagroid::app {

namespace {

struct GradientOptions : SceneOptions {
  std::vector<std::string> of{"final"};
  std::vector<std::string> by{"initial", "parameters"};
  bool check = false;
  std::vector<std::string> deviations;
  Draws draws;
};

/// Prints what was found, and how it went.
template <class Found> int report(const GradientOptions& options, const Found& found, const std::string& failure) {
  if (!options.json && !failure.empty()) {
    complain(fmt::format("{}: {}", options.scene, failure));
    return exit_failed;
  }
  print(options.json ? json_of(found) + "\n" : text_of(found));
  return failure.empty() ? 0 : exit_failed;
}

int gradient_of_scene(const GradientOptions& options, const std::vector<AskGradient>& subjects) {
  const Section scene = read_scene(options.scene, options.overrides);
  const SystemModule& module = module_of_scene(scene);
  for (const AskGradient ask : subjects) {
    const auto subject = ask(module, scene);
    if (!subject) continue;
    try {
      if (!options.deviations.empty()) {
        const Uncertainty found =
            uncertainty_of(*subject, options.of, deviations_of(options.deviations), options.draws);
        return report(options, found, found.table.failure);
      }
      const GradientTable table = differentiate(*subject, options.of, options.by, options.check);
      return report(options, table, table.failure);
    } catch (const GradientRefused& refusal) {
      return refuse(options.json, exit_bad_input, "invalid_command_line", refusal.what());
    } catch (const std::invalid_argument& refusal) {
      return refuse(options.json, exit_bad_input, "no_derivative", refusal.what());
    }
  }
  return refuse(options.json, exit_bad_input, "no_derivative",
                fmt::format("{}: there are no derivatives of runs of {}", options.scene, module.name()));
}

}  // namespace

int gradient_program(int argc, char** argv, ProgramParts parts, const std::vector<AskGradient>& subjects) {
  use_families(std::move(parts.families));
  use_systems(std::move(parts.systems));
  CLI::App app{"exact derivatives of a scene's run, by its start and its parameters", "lagroid gradient"};
  GradientOptions options;
  add_scene_options(app, options);
  app.add_option("--of", options.of,
                 "final.NAME, node.K.NAME or integral.NAME, separated by commas: position, "
                 "momentum, configuration or a column of them (default: all at the end)")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--wrt", options.by, "initial.NAME or parameters.NAME, separated by commas (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
  auto* deviations =
      app.add_option("--deviations", options.deviations,
                     "initial.NAME=SIGMA or parameters.NAME=SIGMA, separated by commas: what independent "
                     "errors of these standard deviations become");
  deviations->delimiter(',')->allow_extra_args(false)->excludes("--wrt");
  app.add_option("--draws", options.draws.count,
                 "with --deviations: compare with so many runs from starts drawn at random")
      ->check(CLI::Range(2L, 10'000'000L))
      ->needs(deviations);
  app.add_option("--seed", options.draws.seed, "of those draws")->needs("--draws");
  app.add_flag("--check", options.check, "compare with extrapolated differences of runs");
  return command_line(app, argc, argv, options, [&] { return gradient_of_scene(options, subjects); });
}

}  // namespace lagroid::app
