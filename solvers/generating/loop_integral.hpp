#pragma once
/// Poincare's relative invariant, the loop integral of p dq around a closed curve of states. Symplectic steps on pair
/// groupoids keep it, which is how symplecticity shows over many steps, where derivatives of the map lose their digits.
///
///     std::vector<State<Pair<1>>> loop;
///     for (double t = 0; t < 6; t += 2 * std::numbers::pi / 9)
///       loop.push_back({Vector<double, 1>(std::cos(t)), Vector<double, 1>(std::sin(t))});
///     const double area = loop_integral<Pair<1>>(loop);
///
/// Requires an odd number of states (std::invalid_argument), at equal steps of the curve's parameter. `carried` is
/// empty where a step of one of them fails.

#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

namespace lagroid {

/// The integral of p dq around a smooth closed curve of states, given at an odd number of equally spaced values of its
/// parameter, on a pair groupoid G = Pair<n>: exact for the trigonometric polynomial through them. Throws
/// std::invalid_argument for an even number.
template <class G> double loop_integral(const std::vector<State<G>>& loop) {
  const int count = int(loop.size());
  if (count % 2 == 0) throw std::invalid_argument("loop_integral: the number of states must be odd");
  double sum = 0;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      if (i == j) continue;
      const double derivative = ((i - j) % 2 == 0 ? 0.5 : -0.5) / std::sin((i - j) * std::numbers::pi / count);
      sum += derivative * loop[std::size_t(i)].momentum.dot(loop[std::size_t(j)].object);
    }
  return 2 * std::numbers::pi / count * sum;
}

/// The loop carried along by `steps` steps of a system; nothing where a step fails.
template <DiscreteSystem Sys>
std::optional<std::vector<State<typename Sys::GroupoidType>>> carried(
    const Sys& system, const std::vector<State<typename Sys::GroupoidType>>& loop, long steps) {
  auto out = loop;
  for (auto& state : out) {
    FixedStepIntegrator<Sys> integrator(system, state, system.groupoid.unit(state.object),
                                        std::make_unique<NewtonStep<Sys>>());
    for (long k = 0; k < steps; ++k)
      if (!integrator.advance().converged()) return std::nullopt;
    state = integrator.point().state;
  }
  return out;
}

}  // namespace lagroid
