#pragma once
/// Laws of a solution of an optimal control problem of a scene of bodies, as control_solution_laws.hpp asks them of
/// other systems: those of optimality, the KKT residual as it stands, and the order of the cost on grids twice and four
/// times as fine.
///
///     const laws::LawReport report = laws::scene_control_laws(scene, found.minima.front());
///     std::cout << report;
///
/// Requires a solution that converged. Returns a LawReport; nothing throws.

#include <lagroid/solvers/control/testing/control_solution_laws.hpp>
#include <lagroid/systems/multibody/control/scene_search.hpp>

#include <cstdint>
#include <utility>

namespace lagroid::laws {

inline LawReport scene_control_laws(multibody::ControlledScene& scene, const multibody::SceneSolution& solution,
                                    const ControlOptions& options = {}, int samples = 20, std::uint64_t seed = 1) {
  multibody::SceneTranscription transcription(scene, solution.path);
  multibody::ScenePath path = solution.path;
  return detail::solution_laws(transcription, solution.report, solution.costates, solution.inequality_multipliers,
                               options, samples, seed, [&](const ControlOptions& near) {
                                 multibody::SceneSolution finer = solve_scene(scene, halved(scene, path), near);
                                 path = std::move(finer.path);
                                 return finer.report;
                               });
}

}  // namespace lagroid::laws
