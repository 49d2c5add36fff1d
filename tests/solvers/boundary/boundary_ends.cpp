// Random ends of the unicycle, the attitude control and the plate-ball: by default, and with any of ten seeds, no path
// found is dearer than the best of 1000 starts. Prints costs, and the time next to that of starts that do not wind.
#include <lagroid/systems/control/attitude_control.hpp>
#include <lagroid/systems/control/plate_ball_boundary.hpp>

#include "boundary_ends.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <random>
#include <vector>

using namespace lagroid;

namespace boundary_boundary_ends_tests {
namespace {

constexpr int random_ends = 20;
constexpr int seeds = 10;

Matrix<double, 3, 3> any_rotation(std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  Vector<double, 4> q;
  for (double& x : q) x = normal(generator);
  return SO3::from_quaternion(q);
}

std::vector<BoundaryStage<Unicycle>> unicycle_stages() {
  std::vector<BoundaryStage<Unicycle>> out;
  for (const auto& end : wound_ends()) out.push_back(end.stage);
  std::mt19937_64 generator(27);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < random_ends; ++i) {
    const double radius = 4 * std::sqrt(std::abs(uniform(generator)));
    const double angle = std::numbers::pi * uniform(generator);
    out.push_back(
        unicycle_to(radius * std::cos(angle), radius * std::sin(angle), std::numbers::pi * uniform(generator)));
  }
  return out;
}

std::vector<BoundaryStage<AttitudeControl>> attitude_stages() {
  std::vector<BoundaryStage<AttitudeControl>> out;
  AttitudeControl system;
  system.weights = {1, 1.5, 1};
  std::mt19937_64 generator(27);
  for (int i = 0; i < random_ends; ++i) out.push_back({{system, any_rotation(generator)}, 100});
  return out;
}

std::vector<BoundaryStage<PlateBall>> plate_ball_stages() {
  std::vector<BoundaryStage<PlateBall>> out;
  PlateBall system;
  system.h = 0.02;
  system.rotation = RotationForm::exponential;
  system.plate_rate = 1;
  system.spin = 0.5;
  std::mt19937_64 generator(27);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto place = [&] {
    const double x = uniform(generator);
    return Vector<double, 2>(x, uniform(generator));
  };
  for (int i = 0; i < random_ends; ++i) {
    const Vector<double, 2> from = place();
    out.push_back({{system, {PairArrow<double, 2>{from, place()}, any_rotation(generator)}}, 50});
  }
  return out;
}

/// The multistart that scenes use of each system.
template <class Sys> MultistartResult<Sys> search(const BoundaryStage<Sys>& stage, const MultistartOptions& options) {
  return solve_boundary(*make_boundary_solver<Sys>(), stage.problem, stage.steps, options);
}
MultistartResult<PlateBall> search(const BoundaryStage<PlateBall>& stage, const MultistartOptions& options) {
  const PlateBallBoundaryOptions own{.steps = long(stage.steps), .starts = options.starts, .seed = options.seed};
  return solve_plate_ball(*make_boundary_solver<PlateBall>(), stage.problem.system, stage.problem.boundary, own);
}

/// Forty starts that are bent but not wound, at the first stage of `search`.
template <class Sys> void search_unwound(const BoundaryStage<Sys>& stage) {
  constexpr std::size_t coarse = 20;
  std::vector<BoundaryStage<Sys>> stages;
  for (std::size_t n = coarse;; n = std::min(2 * n, stage.steps)) {
    stages.push_back({stage.problem, n});
    stages.back().problem.system.h *= double(stage.steps) / double(n);
    if (n == stage.steps) break;
  }
  const auto guess = [&](int index) {
    const auto& problem = stages.front().problem;
    const Path<Sys> straight = geodesic_path(problem, coarse);
    if (index == 0) return straight;
    const double length = problem.system.groupoid.tau_inverse(problem.boundary).norm();
    std::mt19937_64 generator{std::uint64_t(index)};
    std::normal_distribution<double> normal(0, length > 1e-3 ? length : 1);
    return displaced(problem, straight, sine_modes<Sys>(coarse, 3, [&] { return normal(generator); }), 1.0);
  };
  multistart(*make_boundary_solver<Sys>(), stages, 40, guess, [](int) {});
}

template <class F> double processor_seconds(const F& work) {
  const std::clock_t begun = std::clock();
  work();
  return double(std::clock() - begun) / CLOCKS_PER_SEC;
}

template <class Sys> void expect_the_cheapest(const char* name, const std::vector<BoundaryStage<Sys>>& stages) {
  double wound = 0;
  double unwound = 0;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    MultistartOptions many;
    many.starts = 1000;
    many.seed = 12345;
    const auto reference = search(stages[i], many);
    ASSERT_FALSE(reference.solutions.empty());
    const double best = reference.solutions.front().cost;
    unwound += processor_seconds([&] { search_unwound(stages[i]); });
    double dearest = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {  // 1 is the default
      MultistartOptions options;
      options.seed = seed;
      wound += processor_seconds([&] {
        const auto found = search(stages[i], options);
        ASSERT_FALSE(found.solutions.empty());
        dearest = std::max(dearest, found.solutions.front().cost);
      });
    }
    std::printf("%s, end %zu: best of 1000 starts %.10g (%d led there), dearest of %d seeds %.10g\n", name, i + 1, best,
                reference.solutions.front().starts, seeds, dearest);
    EXPECT_LE(dearest, best * (1 + 1e-8)) << name << ", end " << i + 1;
  }
  wound /= seeds;
  std::printf("%s: %.3f s for each end, %.2f times what starts that do not wind take\n", name,
              wound / double(stages.size()), wound / unwound);
  EXPECT_LT(wound, 2 * unwound) << name;
}

TEST(CheapestOfAThousand, Unicycle) { expect_the_cheapest("unicycle", unicycle_stages()); }
TEST(CheapestOfAThousand, AttitudeControl) { expect_the_cheapest("attitude control", attitude_stages()); }
TEST(CheapestOfAThousand, PlateBall) { expect_the_cheapest("plate-ball", plate_ball_stages()); }

}  // namespace
}  // namespace boundary_boundary_ends_tests
