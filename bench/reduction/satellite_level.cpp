// The satellite's body, with the momenta of its wheels fixed.
#include "satellite.hpp"

#include <lagroid/core/reduction/momentum_level.hpp>
#include <lagroid/groupoids/connections.hpp>

namespace reduction {

namespace {

/// Its Routhian, up to a constant: the body's own kinetic term, and j.w.
struct BodyWithFixedMomenta : System<BodyWithFixedMomenta, SO3> {
  Vector<double, 3> inertia = Satellite{}.inertia;
  Vector<double, 3> momenta = satellite_start().momentum.tail<3>();
  template <class S> S lagrangian(const Matrix<S, 3, 3>& g) const {
    const Vector<S, 3> turn = SO3::log(g);
    return kinetic(turn, inertia) + turn(0) * momenta(0) + turn(1) * momenta(1) + turn(2) * momenta(2);
  }
};

}  // namespace

int satellite_level_by_hand(long steps) {
  return integrate(BodyWithFixedMomenta{}, {{}, satellite_start().momentum.head<3>()}, steps);
}
int satellite_level(long steps) {
  const FactorConnection<Factors<1, 2, 3>, SO3, SO2, SO2, SO2> by_wheels;
  const auto start = satellite_start();
  const MomentumLevel level(by_wheels, Satellite{}, start.momentum.tail<3>());
  return integrate(level, level.state_below(start), steps);
}

}  // namespace reduction
