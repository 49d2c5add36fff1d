// As a user writes it: a system of one's own, and steps of it. `lagroid bench` times the compilation of this file.
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <memory>

namespace {

using namespace lagroid;

/// Henon and Heiles' oscillator.
struct Oscillator : System<Oscillator, Pair<2>> {
  double h = 0.01;

  template <class S> S lagrangian(const PairArrow<S, 2>& g) const {
    const Vector<S, 2> d = g.target - g.source;
    const Vector<S, 2> q = (g.source + g.target) * 0.5;
    const S potential = q.squaredNorm() * 0.5 + q(1) * (q(0) * q(0) - q(1) * q(1) / 3.0);
    return d.squaredNorm() * (0.5 / h) - potential * h;
  }
};

}  // namespace

double oscillator_momentum_after(int steps);

double oscillator_momentum_after(int steps) {
  Oscillator system;
  State<Pair<2>> start{{0.1, 0}, {0, 0.4}};
  FixedStepIntegrator<Oscillator> integrator(system, start, system.groupoid.unit(start.object),
                                             std::make_unique<NewtonStep<Oscillator>>());
  for (int k = 0; k < steps && integrator.advance().converged(); ++k) {
  }
  return integrator.point().state.momentum(0);
}
