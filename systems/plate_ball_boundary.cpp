#include <lagroid/systems/plate_ball_boundary.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
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
constexpr int modes = 3;

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
  const auto guess = [&](long steps, const PlateBall& s) {
    return [&, steps](int index) {
      // Each start has its own generator, so that start i is the same whatever the number of starts.
      std::seed_seq sequence{std::uint32_t(options.seed), std::uint32_t(options.seed >> 32), std::uint32_t(index)};
      std::mt19937_64 generator(sequence);
      std::normal_distribution<double> normal(0, 2 * system.radius);
      Eigen::Matrix2Xd amplitude = Eigen::Matrix2Xd::Zero(2, modes);
      if (index > 0)
        for (int j = 0; j < modes; ++j) amplitude.col(j) << normal(generator) / (j + 1), normal(generator) / (j + 1);
      Path<PlateBall> path;
      for (auto& arrow : s.path(boundary, steps, amplitude)) path.push_back({arrow, PlateBall::Multipliers::Zero()});
      return path;
    };
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

  auto result =
      multistart(solver, stages, options.starts, guess(long(stages.front().steps), stages.front().problem.system),
                 options.report, options.threads);
  // Where the grid cannot be refined towards agreement of the forms, or the easier problem led nowhere, the problem
  // asked for gets starts of its own.
  const bool forms_far_apart = first_form != system.rotation && options.steps <= coarse_steps;
  if (stages.size() > 1 && (forms_far_apart || result.solutions.empty())) {
    const auto direct = stage(options.steps, system.rotation);
    auto more = multistart(solver, std::vector{direct}, options.starts, guess(options.steps, direct.problem.system),
                           options.report, options.threads);
    more.iterations += result.iterations;
    for (auto& solution : result.solutions)
      detail::keep_if_new(more.solutions, direct.problem.system, std::move(solution));
    std::sort(more.solutions.begin(), more.solutions.end(),
              [](const auto& x, const auto& y) { return x.cost < y.cost; });
    return more;
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
