#pragma once
/// The planar Kepler problem.

#include <lagroid/systems/instances.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <cmath>

namespace lagroid {

/// A unit mass in the plane around a fixed centre: U = -k / |q|. Momentum p = q'.
struct Kepler : MechanicalSystem<Kepler, 2> {
  double strength = 1;  ///< k, m^3/s^2

  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 2>& q) const {
    using std::sqrt;
    return S(-strength) / sqrt(q.squaredNorm());
  }

  static double angular_momentum(const State<Pair<2>>& s) {
    return s.object(0) * s.momentum(1) - s.object(1) * s.momentum(0);
  }
  std::vector<Quantity<Kepler>> quantities() const {
    return {energy_quantity(),
            {"angular momentum",
             {"L"},
             Promise::conserved,
             false,
             [](const TrajectoryPoint<Kepler>& p, double* out) { *out = angular_momentum(p.state); },
             [](const TrajectoryPoint<Kepler>& p) { return p.state.object.norm() * p.state.momentum.norm(); }}};
  }
};

LAGROID_STEPS(extern template, Kepler);
LAGROID_SOLVERS(extern template, Kepler);

}  // namespace lagroid
