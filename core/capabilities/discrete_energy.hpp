#pragma once
/// The discrete energy of an arrow, E_d = -d(L + <lambda, phi>)/dh.
///
/// It is the energy that a step with free time keeps, where that of the continuous system oscillates.
///
///     const double start = 0;
///     const double energy = discrete_energy(system, step, start, system.h);
///
/// Requires a variational system that takes its step, or its start and step, as arguments (Timed).
/// `discrete_energy_quantity` returns it for a ledger. Nothing throws.
///
/// Source: [G] Example 6.1, with the multiplier's term that the printed equation lacks.

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/quantity.hpp>

#include <cmath>
#include <string>

namespace lagroid {

/// E_d = -d(L + <lambda, phi>)/dh on an arrow that starts at `start` and lasts `step`: minus the momentum of time in
/// the time-extended system ([G] Example 6.1, with the multiplier's term that the printed equation lacks).
template <Timed Sys> double discrete_energy(const Sys& system, const Step<Sys>& step, double start, double over) {
  using D = Dual<double>;
  const auto g = system.groupoid.template cast<D>(step.arrow);
  const D h{over, 1.0};
  double energy = -lagrangian_over(system, g, D(start), h).derivative;
  if constexpr (Sys::arrow_constraints > 0) {
    const auto phi = constraint_over(system, g, D(start), h);
    for (int a = 0; a < Sys::arrow_constraints; ++a) energy -= step.multipliers(a) * phi(a).derivative;
  }
  return energy;
}

/// E_d as a quantity of trajectory points. Its round-off is relative to |E_d| and, where it is conserved, |mu| times
/// the size of the arrow's coordinates over the step, since far from the origin velocities lose digits; where it is
/// bounded, the momentum times the displacement over the step, the size of its kinetic term.
template <Timed Sys> Quantity<Sys> discrete_energy_quantity(const Sys& system, Promise promise) {
  using Point = TrajectoryPoint<Sys>;
  return {"discrete energy E_d",
          {"E_d"},
          promise,
          true,
          [system](const Point& p, double* out) {
            *out = discrete_energy(system, p.step, p.time - p.step_size, p.step_size);
          },
          [system, kept = promise == Promise::conserved](const Point& p) {
            const auto& m = p.state.momentum;
            const double along = kept ? m.cwiseAbs().dot(system.groupoid.coordinate_scale(p.step.arrow))
                                      : std::abs(m.dot(system.groupoid.tau_inverse(p.step.arrow)));
            return std::abs(discrete_energy(system, p.step, p.time - p.step_size, p.step_size)) +
                   along / std::abs(p.step_size);
          }};
}

}  // namespace lagroid
