// As a user writes it: includes a system and steps it. `lagroid bench` times the compilation of this file.
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/control/plate_ball.hpp>

#include <memory>

double plate_ball_momentum_after(int steps);

double plate_ball_momentum_after(int steps) {
  using namespace lagroid;
  PlateBall system;
  State<PlateBall::GroupoidType> start;
  std::get<0>(start.object) << 0.3, -0.2;
  start.momentum << 0.9, 0.2, 0.6, -0.4, 0.8;
  FixedStepIntegrator<PlateBall> integrator(system, start, system.groupoid.unit(start.object),
                                            std::make_unique<NewtonStep<PlateBall>>());
  for (int k = 0; k < steps && integrator.advance().converged(); ++k) {
  }
  return integrator.point().state.momentum(0);
}
