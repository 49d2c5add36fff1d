/// The program lagroid-part: which part of lagroid a command line needs, so that no more is built (./lagroid). Prints
/// its name: a system, bodies, spheres, poisson, optimisation for derivatives of minima, files where no scene is run,
/// or whole.

#include "../command/command.hpp"
#include "../reading/kinds.hpp"
#include "../reading/scene_reader.hpp"
#include "part_names.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using namespace lagroid::app;

constexpr const char* whole = "whole";
constexpr const char* least = "files";

/// The part for a scene: by the key that its family is recognised by.
std::string part_of(const Section& scene, bool of_derivatives) {
  if (of_derivatives && scene.has(keys::optimisation)) return "optimisation";
  if (scene.has(keys::bodies) && !scene.has(keys::control)) return "bodies";
  if (!scene.has(keys::system) || scene.has(keys::sweep) || scene.has(keys::optimisation) || scene.has(keys::control))
    return whole;
  std::vector<std::string> names(systems_with_parts.begin(), systems_with_parts.end());
  const std::size_t of_types = names.size();
  names.insert(names.end(), keys::on_spheres.begin(), keys::on_spheres.end());
  const std::size_t before_brackets = names.size();
  names.insert(names.end(), keys::of_brackets.begin(), keys::of_brackets.end());
  const std::size_t before_formulas = names.size();
  for (const std::string_view each : {keys::lagrangian, keys::hamiltonian}) names.emplace_back(each);
  const std::string name = scene.choice(keys::system, names);
  const auto found = std::size_t(std::find(names.begin(), names.end(), name) - names.begin());
  return found < of_types          ? name
         : found < before_brackets ? "spheres"
         : found < before_formulas ? "poisson"
                                   : "formula";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"which part of lagroid a command line needs"};
  SceneOptions options;
  options.json = asks_for_json(argc, argv);
  std::string out, ignored_word;
  const auto with_scene = [&](const char* name, const char* file) {
    CLI::App* command = app.add_subcommand(name, "");
    command->add_option(file, options.scene);
    command->add_option("--set", options.overrides)->allow_extra_args(false);
    command->add_option("--out", out);
    command->add_option("--covariance", ignored_word);
    command->add_option("--deviations", ignored_word);
    command->allow_extras();
    command->set_help_flag();
    return command;
  };
  const std::array scenes{with_scene("run", "scene"), with_scene("study", "scene"), with_scene("check", "scene"),
                          with_scene("gradient", "scene"), with_scene("fit", "scene")};
  const std::array folders{with_scene("view", "run"), with_scene("plot", "run")};
  const CLI::App* resume = with_scene("resume", "run");
  app.allow_extras();
  app.set_help_flag();
  const auto given = [](const CLI::App* command) { return command->parsed(); };
  return command_line(app, argc, argv, options, [&] {
    std::error_code ignored;
    const auto there = [&](const std::string& file) { return std::filesystem::is_regular_file(file, ignored); };
    const std::string kept = options.scene + "/checkpoint/scene.toml";
    std::string part = whole;
    if (std::any_of(scenes.begin(), scenes.end(), given)) {
      // What is not there is told by the program that is built first.
      const bool of_derivatives = scenes[3]->parsed() || scenes[4]->parsed();
      part = there(options.scene) ? part_of(read_scene(options.scene, options.overrides), of_derivatives) : least;
    } else if (resume->parsed()) {
      part = there(kept) ? part_of(read_scene(kept, {}), false) : least;
    } else if (std::any_of(folders.begin(), folders.end(), given)) {
      part = least;
    }
    print(part + "\n");
    return 0;
  });
}
