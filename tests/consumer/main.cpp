// Integrates a system of its own, and one that the library has compiled, on threads of the library; checks what both
// keep.
#include "spring.hpp"

#include <lagroid/core/version.hpp>
#include <lagroid/solvers/ensemble/tasks.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

using namespace lagroid;

namespace {

/// The largest change over `steps` steps of what `kept` gives; infinite where a step fails.
template <class Sys, class Kept>
double largest_change(const Sys& system, const State<typename Sys::GroupoidType>& start, int steps, const Kept& kept) {
  FixedStepIntegrator<Sys> integrator(system, start, system.groupoid.unit(start.object),
                                      std::make_unique<NewtonStep<Sys>>());
  const auto first = kept(integrator.point());
  double largest = 0;
  for (int k = 0; k < steps; ++k) {
    if (!integrator.advance().converged()) return std::numeric_limits<double>::infinity();
    largest = std::fmax(largest, (kept(integrator.point()) - first).norm());
  }
  return largest;
}

}  // namespace

int main() {
  using One = Vector<double, 1>;
  std::array<double, 2> changes{};
  for_each_task(2, 0, [&](long which) {
    changes[std::size_t(which)] = which == 0
                                      ? largest_change(Spring{}, {{1.2, 0}, {0.3, 1.1}}, 1000,
                                                       [](const auto& point) { return One(point.state.momentum(1)); })
                                      : largest_change(RigidBody{}, {{}, {0.3, 1.5, 0.4}}, 1000, [](const auto& point) {
                                          return Vector<double, 3>(point.configuration * point.state.momentum);
                                        });
  });
  std::printf("lagroid %s: angular momentum changes by %.1e (spring) and %.1e (rigid body)\n", LAGROID_VERSION,
              changes[0], changes[1]);
  return changes[0] < 1e-11 && changes[1] < 1e-11 ? 0 : 1;
}
