#pragma once
/// A step cut short: from a node by a share of its step, with the same equations,
///
///     F-(g, lambda; theta h) = mu,    phi(g; theta h) = 0.
///
/// What happens inside of a step is located by it, to the order of the method and with what the method keeps; the
/// trajectory itself does not notice.
///
///     StepPredictor<Kepler> predictor(Kepler{}, make_step_solver(Kepler{}, StepMethod::newton));
///     TrajectoryPoint<Kepler> from, to;
///     const StepReport report = cut_step(predictor, from, 0.5 * Kepler{}.h, to);
///
/// Requires a system with a time step, which may be cut to any size, a negative one too. The report is the solver's;
/// where it is `converged`, `to` is the point that was reached. The predictor is left as it was, to the last bit.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/quantity.hpp>
#include <lagroid/solvers/integrators/compensated_trajectory.hpp>
#include <lagroid/solvers/step/step_predictor.hpp>

namespace lagroid {

template <DiscreteSystem Sys>
[[gnu::cold]] StepReport cut_step(StepPredictor<Sys>& predictor, const TrajectoryPoint<Sys>& from, double size,
                                  TrajectoryPoint<Sys>& to) {
  NumberArchive kept;
  predictor.serialize(kept);
  predictor.forget();
  set_time_step(predictor.system(), size);
  set_time(predictor.system(), from.time);
  StepSolution<Sys> solution;
  const StepReport report = predictor.solve(from.state, solution);
  NumberArchive restored(kept.numbers());
  predictor.serialize(restored);
  if (!report.converged()) return report;
  const auto& groupoid = predictor.system().groupoid;
  CompensatedTrajectory<Sys> trajectory(groupoid, from.state, from.configuration, from.time);
  trajectory.join(groupoid, solution);
  trajectory.arrive_at(from.time + size, size);
  const long index = from.index + 1;
  to = trajectory.point();
  to.index = index;
  return report;
}

}  // namespace lagroid
