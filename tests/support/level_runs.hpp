#pragma once
/// A full system and what it is at a momentum level, stepped side by side.

#include <lagroid/core/reduction/momentum_level.hpp>

#include "reduced_runs.hpp"

namespace lagroid {

/// Sys at the level of the state z.
template <class Connection, class Sys>
MomentumLevel<Connection, Sys> level_through(const Connection& connection, const Sys& full,
                                             const State<typename Connection::Domain>& z) {
  using Level = MomentumLevel<Connection, Sys>;
  const Level zero(connection, full, Vector<double, Level::angles>::Zero());
  return Level(connection, full, zero.momentum_of(z));
}

/// `reduced` compares the arrows of the base, `object` the full arrows, `momentum` the full momenta.
template <class Connection, class Sys>
ReducedRunDefects run_level_beside(const MomentumLevel<Connection, Sys>& level,
                                   const State<typename Connection::Domain>& z, int steps) {
  using Level = MomentumLevel<Connection, Sys>;
  const auto& full = level.full.groupoid;
  constexpr double offset = 1e-7;
  const auto start = full.unit(z.object);
  FixedStepIntegrator<Sys> above(level.full, z, start, std::make_unique<NewtonStep<Sys>>());
  FixedStepIntegrator<Sys> beside(level.full, {z.object, z.momentum * (1 + offset)}, start,
                                  std::make_unique<NewtonStep<Sys>>());
  const auto z_below = level.state_below(z);
  FixedStepIntegrator<Level> below(level, z_below, level.groupoid.unit(z_below.object),
                                   std::make_unique<NewtonStep<Level>>());
  ReducedRunDefects out;
  for (int k = 0; k < steps; ++k) {
    if (!above.advance().converged() || !beside.advance().converged() || !below.advance().converged())
      throw std::runtime_error("a step failed");
    const auto& p = above.point();
    const auto& q = below.point();
    const auto arrows = [&](const auto& g, const auto& h) {
      return reduced_difference(full.coordinates_of_arrow(g), full.coordinates_of_arrow(h));
    };
    out.reduced =
        std::max(out.reduced, reduced_difference(level.groupoid.coordinates_of_arrow(q.step.arrow),
                                                 level.groupoid.coordinates_of_arrow(level.connection(p.step.arrow))));
    out.object = std::max(out.object, arrows(level.full_arrow(q.step.arrow), p.step.arrow));
    out.momentum =
        std::max(out.momentum,
                 reduced_difference(level.state_over({q.state.object, q.state.momentum}).momentum, p.state.momentum));
    out.growth = std::max({out.growth, arrows(beside.point().step.arrow, p.step.arrow) / offset,
                           reduced_difference(beside.point().state.momentum, p.state.momentum) / offset});
  }
  return out;
}

}  // namespace lagroid
