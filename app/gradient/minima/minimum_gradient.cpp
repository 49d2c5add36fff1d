#include "minimum_gradient.hpp"

#include "../../command/command.hpp"
#include "../../optimise/optimisation_scene.hpp"
#include "../../reading/kinds.hpp"
#include "minimum_table.hpp"

#include <lagroid/run/interrupt.hpp>

#include <fmt/format.h>

#include <new>
#include <stdexcept>

namespace lagroid::app {

namespace {

/// Minimises as the scene says. Throws SceneError. Ctrl-C is noted as long as this goes on, for the best point is told
/// then; what comes after has nothing to tell before its end, and Ctrl-C ends the program.
optimisation::Result minimised(const Section& scene, const OptimisationScene& problem) {
  const InterruptGuard guard;
  const auto watch = [&](const optimisation::Iterate&, const optimisation::Point&) { return !guard.interrupted(); };
  try {
    return optimisation::minimise(*problem.instance.manifold, *problem.instance.objective, problem.start,
                                  *problem.method, problem.stopping, {.callback = watch});
  } catch (const std::invalid_argument& error) {
    scene.section_or_empty("method").fail("", error.what());
  }
}

/// Whether a minimisation ended because nothing fell any more: at a minimum, as derivatives there tell, or elsewhere.
bool nothing_falls(optimisation::MinimisationStatus outcome) {
  using optimisation::MinimisationStatus;
  return outcome == MinimisationStatus::converged || outcome == MinimisationStatus::stationary_start ||
         outcome == MinimisationStatus::stagnated || outcome == MinimisationStatus::no_step;
}

int serve(const Section& scene, const MinimumRequest& request) {
  const std::string name = scene.text(keys::optimisation, "the name of a problem");
  const OptimisationScene problem = read_optimisation(scene, request.scene);
  const auto* objective = dynamic_cast<const optimisation::ParametricObjective*>(problem.instance.objective.get());
  if (objective == nullptr) scene.fail(keys::optimisation, "this problem does not say how it changes with its numbers");
  if (problem.penalty)
    scene.fail("method.constraint", "the minimum of a penalty is none of the problem; take another constraint");
  const ObjectiveNumbers numbers(name, *objective, *problem.instance.manifold);
  MinimumTable table = minimum_table(problem, numbers, request);
  const optimisation::Result result = minimised(scene, problem);
  if (nothing_falls(result.outcome)) differentiate(problem, *objective, result.x, table);
  const bool is_told = table.found.is_minimum() || table.found.status == optimisation::MinimumStatus::no_minimum;
  if (!result.converged() && !is_told) {
    table.status = to_string(result.outcome);
    table.table.failure = result.message;
  }
  const std::string& failure = table.table.failure;
  if (request.json || failure.empty())
    print(request.json ? json_of(table) + "\n" : text_of(table));
  else
    complain(fmt::format("{}: {}", request.scene, failure));
  if (result.outcome == optimisation::MinimisationStatus::interrupted) return exit_interrupted;
  return failure.empty() && table.table.contradicted.empty() ? 0 : exit_failed;
}

}  // namespace

int gradient_of_minimum(const Section& scene, const MinimumRequest& request) {
  try {
    return serve(scene, request);
  } catch (const GradientRefused& refusal) {
    return refuse(request.json, exit_bad_input, "invalid_command_line", refusal.what());
  } catch (const std::bad_alloc&) {
    return refuse(request.json, exit_failed, "out_of_memory",
                  fmt::format("{}: out of memory; ask for fewer numbers", request.scene));
  }
}

}  // namespace lagroid::app
