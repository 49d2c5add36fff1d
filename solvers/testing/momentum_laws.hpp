#pragma once
/// Conservation as laws of any system: every quantity that is promised as conserved is, and declared symmetries are
/// ones, with momenta that stay constant (Noether's theorem).
///
///     const auto draw = [] { return State<Pair<2>>{{1, 0}, {0, 1 + 0.1 * laws::draw_uniform()}}; };
///     std::cout << laws::momentum_laws(Kepler{}, draw) << laws::noether_laws(Kepler{}, Kepler{}.symmetries(), draw);
///
/// A state from which a step fails is passed over; `step_from` throws NotSampled there. [G] Def. 4.8, Theorem 4.9

#include <lagroid/core/noether.hpp>
#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

namespace lagroid::laws {

/// Where a law takes the solvers of steps from.
template <DiscreteSystem Sys> using MakeStepSolver = std::function<std::unique_ptr<StepSolver<Sys>>()>;

template <DiscreteSystem Sys> std::unique_ptr<StepSolver<Sys>> newton_solver() {
  return std::make_unique<NewtonStep<Sys>>();
}

namespace detail {

template <DiscreteSystem Sys>
FixedStepIntegrator<Sys> newton_integrator(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  return FixedStepIntegrator<Sys>(system, start, system.groupoid.unit(start.object), newton_solver<Sys>());
}

/// The round-off of the momenta of a step, which small arrows divide by h: as the size of terms of which a hundred
/// times that round-off is 1e-10.
template <DiscreteSystem Sys>
double size_of_round_off(const Sys& system, const Step<Sys>& step, const TwoSidedOf<Sys>& d) {
  const auto level = round_off_level(system, legendre_minus(system, step), step, StepEquations<Sys>::jacobian(d));
  return 1e12 * level.template head<Sys::dimension>().maxCoeff();
}

/// What to say where no step could be taken.
inline NotSampled no_step(const StepReport& report) {
  return NotSampled("no step from the state drawn (" + std::string(to_string(report.status)) + ")");
}

/// The largest change of a quantity over `steps` steps, relative to its size, with momenta as they are reported.
template <DiscreteSystem Sys>
double drift(const Sys& system, const Quantity<Sys>& quantity, const State<typename Sys::GroupoidType>& start,
             int steps) {
  auto integrator = newton_integrator(system, start);
  std::vector<double> first(quantity.components.size());
  std::vector<double> now(quantity.components.size());
  double size = 0;
  double largest = 0;
  for (int k = 0; k <= steps; ++k) {
    if (k > 0)
      if (const auto report = integrator.advance(); !report.converged()) throw no_step(report);
    if (k == 0 && quantity.needs_step) continue;
    auto point = integrator.point();
    point.state.momentum = tangent_momentum(system, point.state);
    quantity.evaluate(point, now.data());
    if (k == (quantity.needs_step ? 1 : 0)) first = now;
    double norm = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      largest = worst({largest, std::abs(now[i] - first[i])});
      norm += now[i] * now[i];
    }
    size = std::max({size, std::sqrt(norm), quantity.size ? quantity.size(point) : 0.0});
  }
  return largest == 0 ? 0 : largest / size;
}

}  // namespace detail

/// A point of Sigma_L: the first step from a state. Throws NotSampled where it is not solved.
template <DiscreteSystem Sys> Step<Sys> step_from(const Sys& system, const State<typename Sys::GroupoidType>& state) {
  auto integrator = detail::newton_integrator(system, state);
  if (const auto report = integrator.advance(); !report.converged()) throw detail::no_step(report);
  return integrator.point().step;
}

/// For random initial states: every quantity promised as conserved stays where it began over `steps` steps, within
/// `tolerance` relative to its size. `draw()` returns a State; one from which a step fails is passed over.
template <DiscreteSystem Sys, class Draw>
LawReport momentum_laws(const Sys& system, const Draw& draw, int steps = 50, double tolerance = 1e-12) {
  LawReport report{"conserved quantities", {}};
  for (const auto& quantity : quantities_of(system)) {
    if (quantity.promise != Promise::conserved) continue;
    report.laws.push_back(
        check_law(quantity.name, tolerance, [&] { return detail::drift(system, quantity, draw(), steps); }));
  }
  return report;
}

/// Noether's theorem ([G] Theorem 4.9) for declared symmetries: each is one at the steps from random states (Def. 4.8),
/// and its momentum is conserved along random trajectories.
template <DiscreteSystem Sys, class Draw>
LawReport noether_laws(const Sys& system, const std::vector<Symmetry<Sys>>& symmetries, const Draw& draw,
                       int steps = 50, double tolerance = 1e-12) {
  LawReport report{"Noether symmetries", {}};
  for (const auto& symmetry : symmetries) {
    report.laws.push_back(check_law(symmetry.name + " is a symmetry", tolerance,
                                    [&] { return noether_defect(system, step_from(system, draw()), symmetry); }));
    report.laws.push_back(check_law(symmetry.name + " is conserved", tolerance,
                                    [&] { return detail::drift(system, symmetry.quantity(), draw(), steps); }));
  }
  return report;
}

}  // namespace lagroid::laws
