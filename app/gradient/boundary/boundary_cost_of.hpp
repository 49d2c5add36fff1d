#pragma once
/// The subject of `lagroid gradient` of a boundary value: the path that the scene's run finds, and its cost. It finds
/// it at once, and by which parameters the cost has no derivative.
///
///     const GradientSubject subject = cost_subject_of(module.prepare(scene, {}), scene);
///
/// Errors: SceneError for steps that vary and for a system that depends on time.

#include "../../scenes/prepared_scene.hpp"
#include "../gradient_subject.hpp"

#include <lagroid/solvers/boundary/boundary_values.hpp>
#include <lagroid/solvers/sensitivity/boundary/cost_gradient.hpp>

#include <optional>
#include <string>
#include <vector>

namespace lagroid::app {

namespace differentiating {

template <class Sys>
concept HasBoundaryCost = Variational<Sys> && !Forced<Sys> && !Nonholonomic<Sys> && !TimeDependent<Sys>;

/// The cost with ends and parameters that differ, of the path that this one leads to.
template <HasBoundaryCost Sys>
std::optional<double> cost_again(Sys system, Path<Sys> path, const std::vector<Nudge>& nudges) {
  constexpr int n = Sys::dimension;
  Vector<double, n> v = Vector<double, n>::Zero();
  Vector<double, n> w = Vector<double, n>::Zero();
  nudge_parameters(system, nudges);
  for (const Nudge& nudge : nudges)
    if (nudge.parameter.empty()) (nudge.index < n ? v(nudge.index) : w(nudge.index - n)) += nudge.by;
  const auto& groupoid = system.groupoid;
  path.front().arrow = groupoid.translate(v, path.front().arrow, Vector<double, n>(Vector<double, n>::Zero()));
  path.back().arrow = groupoid.translate(Vector<double, n>(Vector<double, n>::Zero()), path.back().arrow, w);
  BoundaryProblem<Sys> problem{system, path.front().arrow};
  for (std::size_t k = 1; k < path.size(); ++k) problem.boundary = groupoid.compose(problem.boundary, path[k].arrow);
  const auto solution = make_boundary_solver<Sys>()->solve(problem, path, /*keep_multipliers=*/true);
  if (!solution.converged()) return std::nullopt;
  return action(system, solution.path);
}

}  // namespace differentiating

template <DiscreteSystem Sys>
GradientSubject cost_subject_of(const PreparedScene<Sys>& prepared, const Section& scene) {
  if constexpr (differentiating::HasBoundaryCost<Sys>) {
    using G = typename Sys::GroupoidType;
    constexpr int n = G::dimension;
    const Section time = scene.section_or_empty("time");
    if (time.has("mode") && time.text("mode", "a word") != "fixed")
      time.fail("mode", "gradient takes boundary values of equal steps; leave it out");
    GradientSubject out;
    out.system = scene.text("system", "the name of a system");
    out.observed = {{"cost", "cost"}};
    for (const char* end : {"start", "end"})
      for (int i = 0; i < n; ++i) {
        out.start.push_back({end, std::string(end) + "." + std::to_string(i)});
        out.sizes.push_back(1);
      }
    name_parameters(prepared.system, out);
    Sys system = prepared.system;
    Path<Sys> path;
    const RunResult result = prepared.run([&](const TrajectoryPoint<Sys>& point) {
      if (point.index == 0) return;
      if constexpr (HasTimeStep<Sys>) set_time_step(system, point.step_size);
      path.push_back(point.step);
    });
    const std::string failure = result.converged() ? "" : result.message;
    if (failure.empty())
      find_refused(out, [&](const std::vector<std::string>& parameters) { cost_gradient(system, path, parameters); });
    out.cost = [system, path, failure](const std::vector<std::string>& parameters) {
      BoundaryCost cost;
      cost.steps = long(path.size());
      cost.failure = failure;
      if (!failure.empty()) return cost;
      const CostGradient found = cost_gradient(system, path, parameters);
      cost.value = found.cost;
      cost.by_ends.resize(2 * n);
      cost.by_ends << found.by_start, found.by_end;
      cost.by_parameters = found.by_parameters;
      cost.again = [system, path](const std::vector<Nudge>& nudges) {
        return differentiating::cost_again(system, path, nudges);
      };
      return cost;
    };
    return out;
  } else {
    scene.fail("boundary", "the cost of a system that depends on time has no derivative here; give [initial]");
  }
}

}  // namespace lagroid::app
