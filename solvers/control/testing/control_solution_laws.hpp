#pragma once
/// Laws of a solution of an optimal control problem: those of optimality (control_laws.hpp), the KKT residual as the
/// problem's own derivatives have it, unscaled, and what its cost does on finer grids,
///
///     c(N) = c + C / N^2 + ...:    log2 (c(N) - c(2N)) / (c(2N) - c(4N)) = 2.
///
/// Where inequalities are active switches may fall between nodes, and the order is then one of the envelope:
/// N^2 |c(N) - c(2N)| and N^2 |c(N) - c(4N)| are bounded by a multiple of the cost.
///
///     const auto found = solve_control(task, 100);
///     const laws::LawReport report = laws::control_solution_laws(task, found);
///     std::cout << report;
///
/// Finer grids are solved from the solution, each arrow in two halves, so that they end in the same minimum. Requires a
/// solution that converged. Returns a LawReport; nothing throws.

#include <lagroid/solvers/control/solve_control.hpp>
#include <lagroid/solvers/testing/control_laws.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace lagroid::laws {

namespace detail {

/// Each arrow tau(q, v) as tau(q, v / 2) and what remains of it.
template <class Sys> ControlTrajectory<Sys> halved(const ControlTask<Sys>& task, const ControlTrajectory<Sys>& path) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = task.system.groupoid;
  ControlTrajectory<Sys> out;
  out.start = path.start;
  for (const PhaseSteps& each : path.phases) out.phases.push_back({2 * each.stages, each.step / 2});
  for (std::size_t k = 0; k < path.arrows.size(); ++k) {
    const ArrowOf<G>& g = path.arrows[k];
    const AlgebroidVector<G> half = groupoid.tau_inverse(g) / 2;
    out.arrows.push_back(groupoid.tau(groupoid.source(g), half));
    out.arrows.push_back(groupoid.project(groupoid.compose(groupoid.inverse(out.arrows.back()), g)));
    out.controls.insert(out.controls.end(), 2, path.controls[k]);
  }
  return out;
}

inline StageRows stage_rows(const std::vector<std::vector<double>>& of, int length) {
  StageRows out(long(of.size()), length);
  for (std::size_t k = 0; k < of.size(); ++k) std::copy(of[k].begin(), of[k].end(), out[long(k)]);
  return out;
}

/// Of the costs on three grids, each twice as fine; infinite where none was found.
inline Law order_law(const double (&costs)[3], long stages, bool has_active_inequalities) {
  const double first = std::abs(costs[0] - costs[1]);
  const double second = std::abs(costs[1] - costs[2]);
  const double size = std::abs(costs[2]);
  const bool all_solved = std::isfinite(costs[0] + costs[1] + costs[2]);
  if (all_solved && std::max(first, second) <= 1e-9 * size)
    return control_law("the cost does not depend on the grid", 0, 0, 3);
  const double off_two = all_solved ? std::abs(std::log2(first / second) - 2) : HUGE_VAL;
  constexpr double about = 0.25;
  if (!has_active_inequalities || off_two <= about)
    return control_law("the cost is of order two in the step", off_two, about, 3);
  const double spread = std::max(first, std::abs(costs[0] - costs[2]));
  return control_law("the cost is of order two in envelope",
                     all_solved ? spread * double(stages) * double(stages) / size : HUGE_VAL, 100, 3);
}

/// Of a solution and of two finer grids: `finer(options)` is the report of the next one, from the one before.
template <class Finer>
LawReport solution_laws(Transcription& transcription, const ControlReport& solved, const StageRows& lambda,
                        const StageRows& z, const ControlOptions& options, int samples, std::uint64_t seed,
                        const Finer& finer) {
  const TranscriptionSizes& sizes = transcription.sizes();
  LawReport report = optimality_laws(transcription, lambda, z, samples, seed);
  StageValues values(sizes);
  StageDerivatives derivatives(sizes);
  TrajectoryDisplacement gradient(sizes);
  transcription.values(values);
  transcription.derivatives(lambda, z, derivatives);
  const KktResidual left = kkt_residual(transcription, values, derivatives, lambda, z, gradient);
  report.laws.push_back(
      control_law("the KKT residual vanishes", std::max(left.stationarity, left.violation), 1e-10, 1));

  bool has_active = false;
  for (std::size_t i = 0; i < z.numbers().size(); ++i)
    has_active = has_active || z.numbers()[i] > -values.inequality.numbers()[i];
  ControlOptions near = options;  // a large barrier parameter would lead away
  near.first_barrier = std::min(options.first_barrier, options.resumed_barrier);
  double costs[3] = {solved.cost};
  for (double* cost : {costs + 1, costs + 2}) {
    const ControlReport next = finer(near);
    *cost = next.converged() ? next.cost : HUGE_VAL;
  }
  report.laws.push_back(order_law(costs, sizes.stages, has_active));
  return report;
}

}  // namespace detail

template <class Sys>
LawReport control_solution_laws(const ControlTask<Sys>& task, const ControlSolution<Sys>& solution,
                                const ControlOptions& options = {}, int samples = 20, std::uint64_t seed = 1) {
  TranscriptionOf<Sys> transcription(task, solution.trajectory);
  const TranscriptionSizes& sizes = transcription.sizes();
  ControlSolution<Sys> finer = solution;
  return detail::solution_laws(transcription, solution.report, detail::stage_rows(solution.costates, sizes.equality),
                               detail::stage_rows(solution.inequality_multipliers, sizes.inequality), options, samples,
                               seed, [&](const ControlOptions& near) {
                                 finer = solve_control(task, detail::halved(task, finer.trajectory), near);
                                 return finer.report;
                               });
}

}  // namespace lagroid::laws
