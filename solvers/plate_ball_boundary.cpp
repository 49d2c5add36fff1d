#include <lagroid/solvers/boundary_ceres.hpp>
#include <lagroid/solvers/boundary_newton.hpp>
#include <lagroid/solvers/plate_ball_boundary.hpp>

#include <fmt/format.h>

#include <random>

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

template <class Solver>
MultistartResult<PlateBall> run(const Solver& solver, const PlateBall& system,
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
  long steps = std::min(options.steps, coarse_steps);
  const RotationForm first_form =
      stage(steps, RotationForm::exponential).problem.system.infeasible() ? system.rotation : RotationForm::exponential;
  stages.push_back(stage(steps, first_form));
  while (steps < options.steps) {
    steps = std::min(2 * steps, options.steps);
    stages.push_back(stage(steps, first_form));
  }
  if (first_form != system.rotation) stages.push_back(stage(steps, system.rotation));

  auto result = multistart(solver, stages, options.starts,
                           guess(long(stages.front().steps), stages.front().problem.system), options.report);
  if (result.solutions.empty() && stages.size() > 1) {
    // The easier problem led nowhere that the one asked for could be reached from: start on that one itself.
    const auto direct = stage(options.steps, system.rotation);
    const int spent = result.iterations;
    result = multistart(solver, std::vector{direct}, options.starts, guess(options.steps, direct.problem.system),
                        options.report);
    result.iterations += spent;
  }
  return result;
}

}  // namespace

MultistartResult<PlateBall> solve_plate_ball(const PlateBall& system, const ArrowOf<PlateBall::GroupoidType>& boundary,
                                             const PlateBallBoundaryOptions& options) {
  BoundaryOptions solver_options;
  solver_options.tolerance = options.tolerance;
  solver_options.max_iterations = options.max_iterations;
  if (options.ceres) return run(BoundaryCeres<PlateBall>(solver_options), system, boundary, options);
  return run(BoundaryNewton<PlateBall>(solver_options), system, boundary, options);
}

}  // namespace lagroid
