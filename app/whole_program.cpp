#include "whole_program.hpp"

#include "command/command_of.hpp"
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

/// A command that `lagroid run` hands scenes over to: its options are those of a scene and a folder `out`.
template <class Options>
ProgramCommand command_of_scenes(const char* name, const char* what, void (*add)(CLI::App&, Options&),
                                 int (*carry_out)(const Options&)) {
  ProgramCommand command = command_of(name, what, add, carry_out);
  command.run_scene = [carry_out](const SceneOptions& scene, const std::optional<std::string>& out) {
    Options options;
    static_cast<SceneOptions&>(options) = scene;
    options.out = out;
    return carry_out(options);
  };
  return command;
}

}  // namespace

ProgramParts whole_program() {
  return {{&systems_family(), &spheres_family(), &poisson_family(), &formula_family(), &bodies_family(),
           &optimisation_family(), &control_family(), &sweeps_family()},
          library_systems(),
          {new_command(), sweep_command(),
           command_of_scenes("optimize", "minimise a function on a manifold (see docs/optimisation.md)",
                             add_optimise_options, optimise),
           command_of_scenes("control", "solve an optimal control problem (see docs/optimal_control.md)",
                             add_control_options, control),
           command_of("learn", "fit a Hamiltonian on (T*S^2)^k or R^2n to trajectories (see docs/learning.md)",
                      add_learn_options, learn),
           command_of("trajectories", "draw trajectories of a pendulum chain into a file, to learn from",
                      add_draw_options, draw),
           command_of("reproduce", "carry out the experiments of a paper, and more", add_reproductions, reproduce)}};
}

}  // namespace lagroid::app
