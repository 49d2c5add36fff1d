// As a user writes it: includes a system and steps it. `lagroid bench` times the compilation of this file.
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/kepler.hpp>

#include <memory>

double kepler_momentum_after(int steps);

double kepler_momentum_after(int steps) {
  using namespace lagroid;
  Kepler system;
  State<Pair<2>> start{{0.8, 0}, {0, 1.2}};
  FixedStepIntegrator<Kepler> integrator(system, start, system.groupoid.unit(start.object),
                                         std::make_unique<NewtonStep<Kepler>>());
  for (int k = 0; k < steps && integrator.advance().converged(); ++k) {
  }
  return integrator.point().state.momentum(0);
}
