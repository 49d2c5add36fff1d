#pragma once
/// A full system and its reduction, stepped side by side from related states.

#include <lagroid/core/reduction/descent.hpp>
#include <lagroid/core/reduction/reconstruct.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace lagroid {

/// The worst differences over a run, relative to one and the size of what is compared: of momenta stepped and then
/// reduced from those reduced and then stepped, and of objects and momenta of the full run from the reconstructed ones.
struct ReducedRunDefects {
  double reduced = 0;
  double object = 0;
  double momentum = 0;
  /// By how much the full motion, of objects and momenta, grows what its initial momentum is off.
  double growth = 1;
  double worst() const { return std::max({reduced, object, momentum}); }
  /// What round-off explains.
  double allowed() const { return 1e-12 * growth; }
};

/// Of b from a, relative to one and the size of b.
template <class A, class B> double reduced_difference(const A& a, const B& b) {
  return (a - b).norm() / (1 + b.norm());
}

/// From the full configuration `start`, an arrow that ends at the initial object, and the momentum there.
template <class Phi, class Sys, class Below = ReducedSystem<Phi, Sys>>
ReducedRunDefects run_side_by_side(const ReducedSystem<Phi, Sys>& reduced, const Below& below_system,
                                   const ArrowOf<typename Phi::Domain>& start,
                                   const AlgebroidVector<typename Phi::Domain>& momentum, int steps) {
  const Phi& phi = reduced.morphism;
  const auto objects = [&](const auto& p, const auto& q) {
    return reduced_difference(phi.from.coordinates_of_object(p), phi.from.coordinates_of_object(q));
  };
  constexpr double offset = 1e-7;
  const State<typename Phi::Domain> z{phi.from.target(start), momentum};
  const State<typename Phi::Domain> near{z.object, momentum * (1 + offset)};
  const auto z_below = reduced.state_below(z);
  FixedStepIntegrator<Sys> above(reduced.full, z, start, std::make_unique<NewtonStep<Sys>>());
  FixedStepIntegrator<Sys> beside(reduced.full, near, start, std::make_unique<NewtonStep<Sys>>());
  FixedStepIntegrator<Below> below(below_system, z_below, phi(start), std::make_unique<NewtonStep<Below>>());
  ReducedRunDefects out;
  for (int k = 0; k < steps; ++k) {
    if (!above.advance().converged() || !beside.advance().converged() || !below.advance().converged())
      throw std::runtime_error("a step failed");
    const auto& p = above.point();
    TrajectoryPoint<ReducedSystem<Phi, Sys>> q;
    q.index = below.point().index;
    q.state = {below.point().state.object, below.point().state.momentum};
    q.configuration = below.point().configuration;
    q.step = {below.point().step.arrow, below.point().step.multipliers};
    const auto lifted = full_point(reduced, q, phi.from.source(start));
    out.reduced = std::max(out.reduced, reduced_difference(phi.reduced_momentum(p.state.object, p.state.momentum),
                                                           below.point().state.momentum));
    out.object = std::max(out.object, objects(lifted.state.object, p.state.object));
    out.momentum = std::max(out.momentum, reduced_difference(lifted.state.momentum, p.state.momentum));
    const auto& other = beside.point().state;
    out.growth = std::max({out.growth, objects(other.object, p.state.object) / offset,
                           reduced_difference(other.momentum, p.state.momentum) / offset});
  }
  return out;
}

/// Whether step then reduce is reduce then step, and the full motion is had back.
inline testing::AssertionResult agree(const ReducedRunDefects& run) {
  if (run.worst() <= run.allowed()) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "reduced " << run.reduced << ", objects " << run.object << ", momenta "
                                     << run.momentum << ", where round-off explains " << run.allowed();
}

}  // namespace lagroid
