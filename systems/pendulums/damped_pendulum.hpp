#pragma once
/// The damped planar pendulum, p' = -m g l sin q - c q': a pendulum with the discrete forces
///
///     f- = f+ = -c (q1 - q0) / 2.
///
/// The smallest forced system: it promises a balance of energy in place of its conservation.
///
///     DampedPendulum pendulum;
///     pendulum.damping = 0.2;
///     const auto forces = pendulum.forces(PairArrow<double, 1>{Vector<double, 1>(0.0), Vector<double, 1>(0.1)});

#include <lagroid/core/capabilities/balance.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>

namespace lagroid {

/// The pendulum with the torque -c q' in its joint: p' = -dU/dq - c q', dE/dt = -c q'^2. On an arrow the impulse
/// -c (q1 - q0) acts by halves on either end.
struct DampedPendulum : Pendulum {
  double damping = 0.1;  ///< c, N m s

  static auto parameters() {
    return std::tuple_cat(Pendulum::parameters(), std::tuple(parameter("damping", &DampedPendulum::damping, "N m s",
                                                                       "torque over angular velocity", nonnegative)));
  }

  template <class S, class T> Forces<S, 1> forces(const PairArrow<S, 1>& g, const T& /*step*/) const {
    const Vector<S, 1> half = (g.target - g.source) * (-0.5 * varied<S>(damping));
    return {half, half};
  }
  template <class S> Forces<S, 1> forces(const PairArrow<S, 1>& g) const { return forces(g, h); }

  /// q' = p / (m l^2), p' = -dU/dq - c q'.
  template <class S = double> RatesOver<Pair<1>, S> rates(const State<Pair<1>, S>& s) const {
    RatesOver<Pair<1>, S> free = Pendulum::rates(s);
    free.momentum -= free.velocity * varied<S>(damping);
    return free;
  }

  /// The continuous solution after time t.
  State<Pair<1>> reference(const State<Pair<1>>& start, double t) const;

  std::vector<Quantity<DampedPendulum>> quantities() const { return {energy_balance(*this)}; }
};

LAGROID_STEPS(extern template, DampedPendulum);
LAGROID_STEP_SOLVERS(extern template, DampedPendulum);

}  // namespace lagroid
