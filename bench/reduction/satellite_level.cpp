// The satellite's body, with the momenta of its wheels fixed.
#include "satellite.hpp"

#include <lagroid/core/reduction/momentum_level.hpp>
#include <lagroid/groupoids/connections.hpp>

namespace reduction {

namespace {

/// Its Routhian: the body's own kinetic term, and j.w - h j.J^{-1} j / 2.
template <class S, class T>
S routhian_of_body(const Satellite& satellite, const Matrix<S, 3, 3>& g, const Vector<T, 3>& momenta) {
  const Vector<S, 3> turn = SO3::log(g);
  T wheels = momenta(0) * momenta(0) / satellite.wheels(0);
  for (int i = 1; i < 3; ++i) wheels += momenta(i) * momenta(i) / satellite.wheels(i);
  return kinetic(turn, satellite.inertia) + turn(0) * momenta(0) + turn(1) * momenta(1) + turn(2) * momenta(2) -
         wheels * (0.5 * h);
}

/// As a person writes it, who leaves the constant out.
struct BodyWithFixedMomenta : System<BodyWithFixedMomenta, SO3> {
  Vector<double, 3> inertia = Satellite{}.inertia;
  Vector<double, 3> momenta = satellite_start().momentum.tail<3>();
  template <class S> S lagrangian(const Matrix<S, 3, 3>& g) const {
    const Vector<S, 3> turn = SO3::log(g);
    return kinetic(turn, inertia) + turn(0) * momenta(0) + turn(1) * momenta(1) + turn(2) * momenta(2);
  }
};

using ByTheWheels = FactorConnection<Factors<1, 2, 3>, SO3, SO2, SO2, SO2>;

/// The satellite, whose user has the paper at hand.
struct SolvedSatellite : System<SolvedSatellite, Placement> {
  Satellite satellite;
  template <class S> S lagrangian(const ArrowOf<Placement, S>& g) const { return satellite.lagrangian<S>(g); }
  template <class S, class T>
  S routhian(const ByTheWheels&, const Matrix<S, 3, 3>& g, const Vector<T, 3>& momenta) const {
    return routhian_of_body(satellite, g, momenta);
  }
};

template <class Full> int integrate_level(long steps) {
  const auto start = satellite_start();
  const MomentumLevel level(ByTheWheels{}, Full{}, start.momentum.tail<3>());
  return integrate(level, level.state_below(start), steps);
}

}  // namespace

int satellite_level_by_hand(long steps) {
  return integrate(BodyWithFixedMomenta{}, {{}, satellite_start().momentum.head<3>()}, steps);
}
int satellite_level(long steps) { return integrate_level<Satellite>(steps); }
int solved_satellite_level(long steps) { return integrate_level<SolvedSatellite>(steps); }

}  // namespace reduction
