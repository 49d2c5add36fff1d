// The Newton iterations on Lie groups: against Rodrigues' formula by hand on SO(3), and their differentials on SO(15).
#include "../cases/lie_newton_case.hpp"

#include <lagroid/groupoids/groups/rotation_fibre.hpp>
#include <lagroid/solvers/newton/lie_differentials.hpp>
#include <lagroid/systems/newton_examples.hpp>

#include "../report/comparison.hpp"

#include <memory>
#include <utility>

namespace bench {

using namespace lagroid;

namespace {

constexpr const char* version1 = "implicit Euler step on SO(3), version 1";
constexpr const char* version2 = "implicit Euler step on SO(3), version 2";
constexpr const char* along = "SO(15), the differential along the group";
constexpr const char* in_chart = "SO(15), the differential in coordinates";
constexpr const char* rodrigues = "by hand, Rodrigues' formula";
constexpr const char* framework = "framework";
constexpr const char* exact = "exact, real Schur form";
constexpr const char* quotients = "finite differences";

/// One solve after the other, from many starting points.
template <class Solve> Subject solves(std::string group, std::string name, Solve solve, bool reference = false) {
  return {std::move(group), std::move(name),
          [starts = lie_newton_starts(), solve](benchmark::State& state) {
            timed(state, [&](long steps) {
              for (long k = 0; k < steps; ++k) {
                const Eigen::Matrix3d y = solve(starts[std::size_t(k) % starts.size()]);
                benchmark::DoNotOptimize(&y);
              }
            });
          },
          reference};
}

template <class Evaluate> Subject matrices(std::string group, std::string name, Evaluate evaluate, bool reference) {
  return {std::move(group), std::move(name),
          [evaluate](benchmark::State& state) {
            timed(state, [&](long steps) {
              for (long k = 0; k < steps; ++k) {
                const Eigen::MatrixXd m = evaluate();
                benchmark::DoNotOptimize(m.data());
              }
            });
          },
          reference};
}

}  // namespace

std::vector<Subject> lie_newton_subjects() {
  std::vector<Subject> out;
  const auto by_hand = [](auto kernel) {
    return [kernel](const Eigen::Matrix3d& z) {
      Eigen::Matrix3d y;
      kernel(z, lie_newton_step, y);
      return y;
    };
  };
  const auto by_framework = [](LieIteration iteration) {
    return [iteration](const Eigen::Matrix3d& z) { return lie_newton_on_so3(z, iteration).y; };
  };
  out.push_back(solves(version1, rodrigues, by_hand(kernels::RodriguesNewton::version1), /*reference=*/true));
  out.push_back(solves(version1, framework, by_framework(LieIteration::version1)));
  out.push_back(solves(version2, rodrigues, by_hand(kernels::RodriguesNewton::version2), /*reference=*/true));
  out.push_back(solves(version2, framework, by_framework(LieIteration::version2)));

  const ImplicitStep<RotationFibre<>, ExampleField<>> step{RotationFibre(random_orthogonal(15, 1)),
                                                           ExampleField(NewtonExample::first), 0.1};
  const Eigen::VectorXd v = step.step() * step.field().g(step.fibre().centre());
  const Eigen::MatrixXd y = step.fibre().at(v);
  const FiniteDifferences differences(step);
  out.push_back(matrices(
      along, exact, [=] { return step.differential(y, v); }, true));
  out.push_back(matrices(
      along, quotients, [=] { return differences.differential(y, v); }, false));
  out.push_back(matrices(
      in_chart, exact, [=] { return step.chart_differential(y, v); }, true));
  out.push_back(matrices(
      in_chart, quotients, [=] { return differences.chart_differential(y, v); }, false));
  return out;
}

std::vector<Goal> lie_newton_goals() {
  return {{version1, framework, rodrigues, 1.5},
          {version2, framework, rodrigues, 1.5},
          {along, quotients, exact, 1.8, /*at_least=*/true},
          {in_chart, quotients, exact, 1.8, /*at_least=*/true}};
}

}  // namespace bench
