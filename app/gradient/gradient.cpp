#include "gradient_table.hpp"
#include "system_gradients.hpp"

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
};

int gradient_of_scene(const GradientOptions& options, const std::vector<AskGradient>& subjects) {
  const Section scene = read_scene(options.scene, options.overrides);
  const SystemModule& module = module_of_scene(scene);
  for (const AskGradient ask : subjects) {
    const auto subject = ask(module, scene);
    if (!subject) continue;
    try {
      const GradientTable table = differentiate(*subject, options.of, options.by, options.check);
      if (!options.json && !table.failure.empty()) {
        complain(fmt::format("{}: {}", options.scene, table.failure));
        return exit_failed;
      }
      print(options.json ? json_of(table) + "\n" : text_of(table));
      return table.failure.empty() ? 0 : exit_failed;
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
  app.add_flag("--check", options.check, "compare with extrapolated differences of runs");
  return command_line(app, argc, argv, options, [&] { return gradient_of_scene(options, subjects); });
}

}  // namespace lagroid::app
