// Numbers that systems observe of their nodes: those of the ledger, with derivatives that are exact.
#include <lagroid/core/continuous/continuous_hamiltonian.hpp>
#include <lagroid/core/testing/observed_laws.hpp>
#include <lagroid/core/testing/sampling.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/systems/control/attitude_control.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/control/unicycle.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>
#include <lagroid/systems/rolling/rolling_disk.hpp>
#include <lagroid/systems/rotations/driven_body.hpp>
#include <lagroid/systems/rotations/gyrostat.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace lagroid {
namespace {

/// Any state: an object at some distance from the origin, where there are places, and any momentum.
template <class Sys> laws::ObservedState<Sys> any_node(const Sys& system) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = system.groupoid;
  constexpr int objects = G::object_coordinate_count();
  laws::ObservedState<Sys> node;
  Vector<double, objects> place = laws::draw_vector<objects>(0.5);
  place.array() += 1;
  node.configuration = groupoid.tau(groupoid.template object_at<double>(place),
                                    Vector<double, G::dimension>(laws::draw_vector<G::dimension>(0.5)));
  node.state = {groupoid.target(node.configuration), laws::draw_vector<G::dimension>(1.0)};
  return node;
}
/// All that the ledger watches of nodes is observed, too, but for what are numbers of the state.
template <class Sys, class Draw>
void expect_observed(const Sys& system, const Draw& draw, const std::set<std::string>& of_state = {}) {
  const laws::LawReport report = laws::observed_laws(system, draw);
  EXPECT_TRUE(report.holds()) << report;
  std::set<std::string> names;
  for (const ObservedName& each : Sys::observed_names()) names.insert(each.name);
  for (const Quantity<Sys>& each : quantities_of(system))
    if (each.serialize || each.needs_step || of_state.contains(each.name))
      continue;
    else if (each.components.size() == 1)
      EXPECT_TRUE(names.contains(each.name)) << each.name;
    else
      for (const std::string& name : each.components) EXPECT_TRUE(names.contains(name)) << name;
}
template <class Sys> void expect_observed(const Sys& system) {
  expect_observed(system, [&] { return any_node(system); });
}

TEST(ObservedNumbers, OfPendulumsAreTheLedgers) {
  expect_observed(Pendulum{});
  expect_observed(DampedPendulum{});
  expect_observed(SphericalPendulum{});
}
TEST(ObservedNumbers, OfKeplersProblemAreTheLedgers) { expect_observed(Kepler{}); }
TEST(ObservedNumbers, OfBodiesThatTurnAreTheLedgers) {
  expect_observed(RigidBody{});
  DrivenBody driven;
  driven.torque = {0.1, 0.2, 0.3};
  expect_observed(driven);
  expect_observed(Gyrostat{});
  HeavyTop lagrange;
  expect_observed(lagrange);
  HeavyTop kovalevskaya;
  kovalevskaya.weight = {1.5, 0.5, 0};
  ASSERT_TRUE(kovalevskaya.is_kovalevskaya());
  expect_observed(kovalevskaya);
}
TEST(ObservedNumbers, OfWhatRollsAreTheLedgers) {
  expect_observed(RollingDisk{});
  RollingBall ball;
  expect_observed(ball);
  ball.plate_rate = 0.7;
  expect_observed(ball);
}
TEST(ObservedNumbers, OfTheSleighAreTheLedgers) {
  const ChaplyginSleigh sleigh;
  expect_observed(sleigh, [&] {
    laws::ObservedState<ChaplyginSleigh> node = any_node(sleigh);
    node.state = sleigh.sliding(laws::draw_uniform(), laws::draw_uniform());
    return node;
  });
}
TEST(ObservedNumbers, OfControlAreTheLedgers) {
  expect_observed(Unicycle{});
  AttitudeControl turn;
  turn.weights = {1.5, 1.5, 2};
  ASSERT_TRUE(turn.is_axial());
  expect_observed(turn);
  PlateBall plate;
  expect_observed(plate, [&] { return any_node(plate); }, {"translational momentum"});
  plate.plate_rate = 0.4;
  plate.spin = 0.3;
  expect_observed(plate);
}

/// A cart that rolls where it points, on a plane that slopes, by its Lagrangian: its velocity and multiplier are found
/// by Newton's method.
struct Cart : ContinuousLagrangian<SE2, 1> {
  double mass = 1.3;
  static auto parameters() { return std::tuple(parameter("mass", &Cart::mass, "kg", "of the cart", positive)); }
  template <class S> S l(const Vector<S, 0>&, const Vector<S, 3>& xi) const {
    return (xi(0) * xi(0) * (xi(1) * xi(1) + 2.0) + xi(1) * xi(1) * varied<S>(mass) + xi(2) * xi(2)) * 0.5;
  }
  template <class S> Vector<S, 1> psi(const Vector<S, 0>&, const Vector<S, 3>& xi) const {
    return Vector<S, 1>(xi(2) - xi(0) * varied<S>(mass) * 0.2);
  }
};
struct Quartic : ContinuousHamiltonian<Quartic, Pair<1>> {
  template <class S> S hamiltonian(const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    return p(0) * p(0) * 0.5 + q(0) * q(0) * q(0) * q(0) * 0.25;
  }
};
TEST(ObservedNumbers, OfLagrangiansAndHamiltoniansAreTheLedgers) {
  expect_observed(Midpoint<Cart>{});
  expect_observed(Midpoint<Quartic>{});
}

/// A spring, to be observed wrongly.
template <class Derived> struct Spring : MechanicalSystem<Derived, 1> {
  double bob = 1.5;
  static auto parameters() { return std::tuple(parameter("mass", &Derived::bob, "kg", "of the bob", positive)); }
  template <class S = double> ParameterScalar<S> mass() const { return varied<S>(bob); }
  template <class S> S potential(const Vector<S, 1>& q) const { return q(0) * q(0) * 0.5; }
  std::vector<Quantity<Derived>> quantities() const { return {this->energy_quantity()}; }
};
using Line = Pair<1>;
struct PlainMass : Spring<PlainMass> {
  template <class S> Vector<S, 1> observed(const State<Line, S>& s, const PairArrow<S, 1>&) const {
    return Vector<S, 1>(s.momentum(0) * s.momentum(0) / (2 * bob) + potential(s.object));
  }
};
struct Doubled : Spring<Doubled> {
  template <class S> Vector<S, 1> observed(const State<Line, S>& s, const PairArrow<S, 1>&) const {
    return Vector<S, 1>((kinetic_energy(s.momentum) + potential(s.object)) * 2.0);
  }
};
struct HeldPlace : Spring<HeldPlace> {
  template <class S> Vector<S, 1> observed(const State<Line, S>& s, const PairArrow<S, 1>&) const {
    return Vector<S, 1>(kinetic_energy(s.momentum) + value_of(s.object(0)) * value_of(s.object(0)) * 0.5);
  }
};

struct TooMany : Spring<TooMany> {
  template <class S> Vector<S, 2> observed(const State<Line, S>& s, const PairArrow<S, 1>&) const {
    return {kinetic_energy(s.momentum), potential(s.object)};
  }
};

TEST(ObservedNumbersBroken, AreSeen) {
  const auto broken = [](const auto& system, const char* law) {
    const laws::Sampling sampling(5, 1);
    const laws::LawReport report = laws::observed_laws(system, [&] { return any_node(system); });
    EXPECT_FALSE(report.law(law).holds()) << report;
  };
  broken(TooMany{}, "there are as many as names");
  broken(PlainMass{}, "slopes by parameters are those of differences");
  broken(Doubled{}, "they are the ledger's");
  broken(HeldPlace{}, "slopes by the node are those of differences");
}

}  // namespace
}  // namespace lagroid
