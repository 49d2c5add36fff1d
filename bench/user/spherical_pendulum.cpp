// As a user writes it: includes a system and steps it. `lagroid bench` times the compilation of this file.
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>

#include <memory>

double spherical_pendulum_momentum_after(int steps);

double spherical_pendulum_momentum_after(int steps) {
  using namespace lagroid;
  SphericalPendulum system;
  State<Pair<3>> start{{0.6, 0, -0.8}, {0.4, 0.9, 0.3}};
  FixedStepIntegrator<SphericalPendulum> integrator(system, start, system.groupoid.unit(start.object),
                                                    std::make_unique<NewtonStep<SphericalPendulum>>());
  for (int k = 0; k < steps && integrator.advance().converged(); ++k) {
  }
  return integrator.point().state.momentum(0);
}
