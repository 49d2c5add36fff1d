#pragma once
/// Systems that the library reduces, each beside the reduced one as a person writes it. Callgrind counts what a step
/// takes (chapters/reduction.cpp).

#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <memory>

namespace reduction {

using namespace lagroid;

constexpr double h = 0.01;

/// Takes so many steps. Returns whether one failed, as a program does.
template <class Sys> int integrate(const Sys& system, const State<typename Sys::GroupoidType>& start, long steps) {
  FixedStepIntegrator<Sys> run(system, start, system.groupoid.unit(start.object), std::make_unique<NewtonStep<Sys>>());
  for (long k = 0; k < steps; ++k)
    if (!run.advance().converged()) return 1;
  return 0;
}

/// What each file contributes.
int body_by_hand(long steps);
int body_reduced(long steps);
int satellite_by_hand(long steps);
int satellite_reduced(long steps);
int satellite_level_by_hand(long steps);
int satellite_level(long steps);
int solved_satellite_level(long steps);
int planet_level_by_hand(long steps);
int planet_level(long steps);
int solved_planet_level(long steps);

}  // namespace reduction
