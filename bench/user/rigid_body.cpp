// As a user writes it: includes a system and steps it. `lagroid bench` times the compilation of this file.
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <memory>

double rigid_body_momentum_after(int steps);

double rigid_body_momentum_after(int steps) {
  using namespace lagroid;
  RigidBody system;
  State<SO3> start;
  start.momentum << 0.4, 1.9, -1.1;
  FixedStepIntegrator<RigidBody> integrator(system, start, system.groupoid.unit(start.object),
                                            std::make_unique<NewtonStep<RigidBody>>());
  for (int k = 0; k < steps && integrator.advance().converged(); ++k) {
  }
  return integrator.point().state.momentum(0);
}
