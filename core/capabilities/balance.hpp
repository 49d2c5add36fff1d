#pragma once
/// Quantities that change by a known amount at each step: I(z_k) - gain(g_1) - ... - gain(g_k), which is constant.
///
/// A dissipative or nonholonomic system keeps no energy or momentum, but a balance, and a ledger can watch that.
///
///     std::vector<Quantity<Sys>> quantities() const {
///       return {energy_balance(*this), momentum_balance(*this, symmetries()[0])};
///     }
///
/// Requires that the quantity is evaluated at every point of a trajectory in order, from index 0 on; it is not a number
/// after a point was left out. `energy_balance` requires discrete forces, a time step and `energy(state)`. Nothing
/// throws.
///
/// Source: Cortes & Martinez 2001 and Iglesias et al. 2008 for the discrete nonholonomic momentum equation.

#include <lagroid/core/noether.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>

namespace lagroid {

/// value(z_k) - gain(g_1) - ... - gain(g_k): constant where gain is by how much each arrow changes the value.
///
/// The sum is kept by the quantity, which must therefore see every point of a trajectory in order, from index 0 on, and
/// is not a number where one was left out. The same point again changes nothing; index 0 begins anew. Copies share it.
template <class Sys>
Quantity<Sys> balance(std::string name, Promise promise,
                      std::function<double(const State<typename Sys::GroupoidType>&)> value,
                      std::function<double(const Step<Sys>&)> gain, typename Quantity<Sys>::Size size) {
  struct Account {
    long index = 0;
    double gained = 0;
  };
  const auto account = std::make_shared<Account>();
  const auto evaluate = [value = std::move(value), gain = std::move(gain), account](const TrajectoryPoint<Sys>& p,
                                                                                    double* out) {
    if (p.index == 0) {
      *account = {};
    } else if (p.index == account->index + 1) {
      *account = {p.index, account->gained + gain(p.step)};
    } else if (p.index != account->index) {
      account->gained = std::numeric_limits<double>::quiet_NaN();
    }
    *out = value(p.state) - account->gained;
  };
  Quantity<Sys> quantity{name, {name}, promise, false, evaluate, std::move(size)};
  quantity.serialize = [account](NumberArchive& archive) { archive(account->index, account->gained); };
  return quantity;
}

/// The discrete nonholonomic momentum equation along a section X of D (Cortes & Martinez 2001; Iglesias et al. 2008,
/// on the discrete nonholonomic momentum map): with J_k = <mu_k, X(q_k)>, and f-, f+ the discrete forces if there are
/// any,
///
///     J_k - J_{k-1} = X<-[L](g_k) - X->[L](g_k) + <f+(g_k), X(q_k)> + <f-(g_k), X(q_{k-1})>.
///
/// The reaction is not in it: X must annihilate it, or the balance is broken. Where X leaves L unchanged and there are
/// no forces the right side is zero, and J itself is conserved.
template <DiscreteSystem Sys> Quantity<Sys> momentum_balance(const Sys& system, const Symmetry<Sys>& along) {
  using Z = State<typename Sys::GroupoidType>;
  return balance<Sys>(
      "momentum equation of " + along.name, Promise::conserved, [along](const Z& z) { return along.momentum(z); },
      [system, along](const Step<Sys>& step) {
        const auto d = gradients(system, step.arrow, Sys::Multipliers::Zero().eval());
        return d.target_gradient.dot(along.section(system.groupoid.target(step.arrow))) +
               d.source_gradient.dot(along.section(system.groupoid.source(step.arrow)));
      },
      [along](const TrajectoryPoint<Sys>& p) { return along.size(p.state); });
}

/// The work of the discrete forces along g: the force, half of it seen from either end, times the displacement over the
/// arrow.
template <Forced Sys>
requires HasTimeStep<Sys>
double work(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g) {
  const auto& groupoid = system.groupoid;
  const Forces<double, Sys::dimension> impulse = system.forces(g);
  return (impulse.source.dot(groupoid.tau_inverse(g)) - impulse.target.dot(groupoid.tau_inverse(groupoid.inverse(g)))) /
         system.h;
}

/// The energy less the work of the forces. The system's `energy(state)` is that of the continuous system, which the
/// discrete flow keeps within a band.
template <Forced Sys> Quantity<Sys> energy_balance(const Sys& system) {
  using Z = State<typename Sys::GroupoidType>;
  const auto energy = [system](const Z& z) { return system.energy(z); };
  return balance<Sys>(
      "energy less work", Promise::bounded, energy,
      [system](const Step<Sys>& step) { return work(system, step.arrow); },
      [energy](const TrajectoryPoint<Sys>& p) { return std::abs(energy(p.state)); });
}

}  // namespace lagroid
