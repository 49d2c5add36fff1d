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

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lagroid::laws {

inline LawReport scene_control_laws(multibody::ControlledScene& scene, const multibody::SceneSolution& solution,
                                    const ControlOptions& options = {}, int samples = 20, std::uint64_t seed = 1) {
  multibody::SceneTranscription transcription(scene, solution.path);
  const TranscriptionSizes& sizes = transcription.sizes();
  const StageRows& lambda = solution.costates;
  const StageRows& z = solution.inequality_multipliers;
  LawReport report = optimality_laws(transcription, lambda, z, samples, seed);

  StageValues values(sizes);
  StageDerivatives derivatives(sizes);
  TrajectoryDisplacement gradient(sizes);
  transcription.values(values);
  transcription.derivatives(lambda, z, derivatives);
  const KktResidual left = kkt_residual(transcription, values, derivatives, lambda, z, gradient);
  report.laws.push_back(
      detail::control_law("the KKT residual vanishes", std::max(left.stationarity, left.violation), 1e-10, 1));

  double costs[3] = {solution.report.cost};
  bool has_active = false;
  for (std::size_t i = 0; i < z.numbers().size(); ++i)
    has_active = has_active || z.numbers()[i] > -values.inequality.numbers()[i];
  multibody::ScenePath path = solution.path;
  ControlOptions near = options;  // a large barrier parameter would lead away
  near.first_barrier = std::min(options.first_barrier, options.resumed_barrier);
  for (double* cost : {costs + 1, costs + 2}) {
    const multibody::SceneSolution finer = solve_scene(scene, halved(scene, path), near);
    *cost = finer.report.converged() ? finer.report.cost : HUGE_VAL;
    path = finer.path;
  }
  report.laws.push_back(detail::order_law(costs, sizes.stages, has_active));
  return report;
}

}  // namespace lagroid::laws
