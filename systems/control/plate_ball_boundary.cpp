#include <lagroid/systems/control/plate_ball_boundary.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lagroid {

std::optional<std::string> unreachable(const PlateBall& system, long steps) {
  if (steps < 3)
    return fmt::format(
        "a plate-ball boundary-value problem needs at least 3 steps (2 controls a step, 5 conditions), got {}", steps);
  return system.infeasible();
}

namespace {

constexpr long coarse_steps = 20;

/// Of a ball of unit radius.
MultistartResult<PlateBall> run(const BoundarySolver<PlateBall>& solver, const PlateBall& system,
                                const ArrowOf<PlateBall::GroupoidType>& boundary,
                                const PlateBallBoundaryOptions& options) {
  const double horizon = system.h * double(options.steps);
  const auto stage = [&](long steps, RotationForm form) {
    PlateBall s = system;
    s.h = steps == options.steps ? system.h : horizon / double(steps);
    s.rotation = form;
    return BoundaryStage<PlateBall>{{s, boundary}, std::size_t(steps)};
  };
  std::vector<BoundaryStage<PlateBall>> stages;
  // Coarse enough to be quick, fine enough that the prescribed spin turns by no more than 1.5 a step.
  const double turns = std::ceil(std::abs(system.spin) * horizon / 1.5);
  long steps = std::min(options.steps, std::max(coarse_steps, long(std::min(turns, 1e9))));
  const RotationForm first_form =
      stage(steps, RotationForm::exponential).problem.system.infeasible() ? system.rotation : RotationForm::exponential;
  stages.push_back(stage(steps, first_form));
  while (steps < options.steps) {
    steps = std::min(2 * steps, options.steps);
    stages.push_back(stage(steps, first_form));
  }
  if (first_form != system.rotation) stages.push_back(stage(steps, system.rotation));

  const MultistartOptions multistart{.starts = options.starts,
                                     .seed = options.seed,
                                     .amplitude = 2,
                                     .report = options.report,
                                     .threads = options.threads};
  auto result = solve_stages(solver, stages, multistart);
  // Where the grid cannot be refined towards agreement of the forms, the form asked for gets starts of its own.
  if (first_form != system.rotation && options.steps <= coarse_steps) {
    auto direct = solve_stages(solver, {stages.back()}, multistart);
    direct.add_effort(result);
    for (auto& solution : result.solutions)
      detail::keep_if_new(direct.solutions, stages.back().problem.system, std::move(solution));
    std::sort(direct.solutions.begin(), direct.solutions.end(),
              [](const auto& x, const auto& y) { return x.cost < y.cost; });
    return direct;
  }
  return result;
}

}  // namespace

MultistartResult<PlateBall> solve_plate_ball(const BoundarySolver<PlateBall>& solver, const PlateBall& system,
                                             const ArrowOf<PlateBall::GroupoidType>& boundary,
                                             const PlateBallBoundaryOptions& options) {
  if (const auto why = unreachable(system, options.steps)) throw std::invalid_argument(*why);
  if (!system.groupoid.coordinates_of_arrow(boundary).allFinite())
    throw std::invalid_argument("the boundary arrow is not finite");
  // Solved with the radius as the unit of length: lengths scale by r, the cost and M by r^2, and so multiply
  // lambda1, lambda2 by r and lambda3 by r^2.
  const double r = system.radius;
  PlateBall unit = system;
  unit.radius = 1;
  ArrowOf<PlateBall::GroupoidType> scaled = boundary;
  std::get<0>(scaled).source /= r;
  std::get<0>(scaled).target /= r;
  auto result = run(solver, unit, scaled, options);
  const auto restore = [&](BoundarySolution<PlateBall>& solution) {
    solution.cost *= r * r;
    for (auto& [arrow, lambda] : solution.path) {
      std::get<0>(arrow).source *= r;
      std::get<0>(arrow).target *= r;
      lambda = lambda.cwiseProduct(Vector<double, 3>(r, r, r * r)).eval();
    }
  };
  for (auto& solution : result.solutions) restore(solution);
  restore(result.best_failure);
  return result;
}

}  // namespace lagroid
