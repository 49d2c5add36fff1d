#include "whole_program.hpp"

#include "control/control.hpp"
#include "learn/draw.hpp"
#include "learn/learn.hpp"
#include "optimise/optimise.hpp"
#include "own/new_folder.hpp"
#include "reproduce.hpp"
#include "sweep/sweep.hpp"
#include "systems/library_systems.hpp"

namespace lagroid::app {

namespace {

ProgramCommand optimize_command() {
  ProgramCommand command = command_of("optimize", "minimise a function on a manifold (see docs/optimisation.md)",
                                      add_optimise_options, optimise);
  command.run_scene = [](const SceneOptions& scene, const std::optional<std::string>& out) {
    OptimiseOptions options;
    static_cast<SceneOptions&>(options) = scene;
    options.out = out;
    return optimise(options);
  };
  return command;
}

ProgramCommand control_command() {
  ProgramCommand command = command_of("control", "solve an optimal control problem (see docs/optimal_control.md)",
                                      add_control_options, control);
  command.run_scene = [](const SceneOptions& scene, const std::optional<std::string>& out) {
    ControlCommandOptions options;
    static_cast<SceneOptions&>(options) = scene;
    options.out = out;
    return control(options);
  };
  return command;
}

}  // namespace

ProgramParts whole_program() {
  return {{&systems_family(), &spheres_family(), &poisson_family(), &bodies_family(), &optimisation_family(),
           &control_family(), &sweeps_family()},
          library_systems(),
          {new_command(), sweep_command(), optimize_command(), control_command(),
           command_of("learn", "fit a Hamiltonian on (T*S^2)^k to trajectories (see docs/learning.md)",
                      add_learn_options, learn),
           command_of("trajectories", "draw trajectories of a pendulum chain into a file, to learn from",
                      add_draw_options, draw),
           command_of("reproduce", "carry out the experiments of a paper, and more", add_reproductions, reproduce)}};
}

}  // namespace lagroid::app
