#pragma once
/// The law that every solver of steps must satisfy: it solves what NewtonStep solves, to the same arrow, multipliers
/// and momentum, for thousands of steps.
///
///     const auto draw = [] { return State<Pair<2>>{{1, 0}, {0, 1 + 0.1 * laws::draw_uniform()}}; };
///     std::cout << laws::solver_laws(Kepler{}, draw, StepMethod::ceres, 100);  // for 100 steps
///
/// States from which NewtonStep fails are passed over.

#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace lagroid::laws {

/// Along trajectories of `steps` steps that a solver from `make()` integrates from random states: it solves every step
/// that NewtonStep solves, and to the same arrow, multipliers and momentum within `tolerance`, relative to their size
/// or to one, if that is more. Both start each step from the continuation of their own steps before. A state from which
/// NewtonStep does not come to the end is passed over. `draw()` returns a State.
template <DiscreteSystem Sys, class Draw>
LawReport solver_laws(const Sys& system, const Draw& draw, const std::type_identity_t<MakeStepSolver<Sys>>& make,
                      int steps = 2000, double tolerance = 1e-10) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = system.groupoid;
  LawReport report{"solver of steps", {}};
  report.laws.push_back(check_law("steps are solved as by Newton", tolerance, [&] {
    const State<G> start = draw();
    FixedStepIntegrator<Sys> integrator(system, start, groupoid.unit(start.object), make());
    StepPredictor<Sys> newton(system, std::make_unique<NewtonStep<Sys>>());
    double largest = 0;
    for (int k = 0; k < steps; ++k) {
      const State<G> from = integrator.point().state;
      StepSolution<Sys> expected;
      set_time(newton.system(), start_time(integrator.system()));
      if (const auto found = newton.solve(from, expected); !found.converged()) throw detail::no_step(found);
      if (const auto found = integrator.advance(); !found.converged())
        throw std::runtime_error("step " + std::to_string(k + 1) + ": " + std::string(to_string(found.status)));
      const auto& point = integrator.point();
      largest = worst({largest,
                       detail::relative_defect(groupoid.coordinates_of_arrow(point.step.arrow),
                                               groupoid.coordinates_of_arrow(expected.step.arrow)),
                       detail::relative_defect(point.step.multipliers, expected.step.multipliers),
                       detail::relative_defect(point.state.momentum,
                                               AlgebroidVector<G>(from.momentum + expected.momentum_change))});
    }
    return largest;
  }));
  return report;
}

/// The same of the solvers a scene can name. Include `step_methods.hpp` for a system of your own; those of `systems/`
/// are compiled.
template <DiscreteSystem Sys, class Draw>
LawReport solver_laws(const Sys& system, const Draw& draw, StepMethod method, int steps = 2000,
                      double tolerance = 1e-10) {
  return solver_laws(
      system, draw, [&] { return make_step_solver(system, method); }, steps, tolerance);
}

}  // namespace lagroid::laws
