// The classical Runge-Kutta method: its order, and what it does not keep.

#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rolling/rolling_disk.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

using namespace lagroid;

namespace integrators_runge_kutta_tests {
namespace {

static_assert(HasRates<Kepler> && HasRates<RigidBody> && HasRates<HeavyTop> && HasRates<SphericalPendulum>);
static_assert(HasRates<DampedPendulum> && !HasRates<RollingDisk>);

template <class Sys>
std::unique_ptr<Integrator<Sys>> runge_kutta(Sys system, const State<typename Sys::GroupoidType>& start,
                                             const ArrowOf<typename Sys::GroupoidType>& configuration, double h) {
  system.h = h;
  return make_integrator(system, start, configuration, {.fixed = StepKind::runge_kutta});
}

template <class Sys> Eigen::VectorXd end_of(Integrator<Sys>& integrator, const Sys& system, long steps) {
  for (long k = 0; k < steps; ++k) EXPECT_TRUE(integrator.advance().converged());
  const auto arrow = system.groupoid.coordinates_of_arrow(integrator.point().configuration);
  Eigen::VectorXd out(arrow.size() + Sys::dimension);
  out << arrow, integrator.point().state.momentum;
  return out;
}

template <class Sys>
double order_of(const Sys& system, const State<typename Sys::GroupoidType>& start,
                const ArrowOf<typename Sys::GroupoidType>& configuration,
                const State<typename Sys::GroupoidType>& exact, const ArrowOf<typename Sys::GroupoidType>& reached,
                double horizon) {
  const auto arrow = system.groupoid.coordinates_of_arrow(reached);
  Eigen::VectorXd truth(arrow.size() + Sys::dimension);
  truth << arrow, exact.momentum;
  return laws::measured_order({[&](int steps) {
                                 const auto integrator = runge_kutta(system, start, configuration, horizon / steps);
                                 EXPECT_EQ(integrator->traits().order, 4);
                                 return end_of(*integrator, system, steps);
                               },
                               truth, 40, 1e-10});
}

TEST(RungeKutta, IsOfOrderFour) {
  const Kepler kepler;
  const State<Pair<2>> orbit{{0.7, 0}, {0.1, 1.2}};
  auto exact = kepler.reference(orbit, 3);
  EXPECT_NEAR(order_of(kepler, orbit, {orbit.object, orbit.object}, exact, {orbit.object, exact.object}, 3), 4, 0.1);

  DampedPendulum damped;
  damped.damping = 0.3;
  const State<Pair<1>> swing{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
  const auto slowed = damped.reference(swing, 4);
  EXPECT_NEAR(order_of(damped, swing, {swing.object, swing.object}, slowed, {swing.object, slowed.object}, 4), 4, 0.1);

  const SphericalPendulum pendulum;
  const State<Pair<3>> bob{{0.6, 0, -0.8}, {0.4, 0.7, 0.3}};
  const auto swung = pendulum.reference(bob, 3);
  EXPECT_NEAR(order_of(pendulum, bob, {bob.object, bob.object}, swung, {bob.object, swung.object}, 3), 4, 0.1);

  const RigidBody body;
  State<SO3> turning;
  turning.momentum << 0.3, 1.5, 0.4;
  Matrix<double, 3, 3> attitude = SO3::exp(Vector<double, 3>(0.2, 0.1, -0.4));
  const Matrix<double, 3, 3> first = attitude;
  const auto turned = body.reference(turning, attitude, 5);
  EXPECT_NEAR(order_of(body, turning, first, turned, attitude, 5), 4, 0.1);

  HeavyTop top;
  top.inertia << 1.1, 0.8, 0.5;
  top.weight << 0.3, -0.2, 0.9;
  const Vector<double, 3> e3(0, 0, 1);
  const State<HeavyTop::GroupoidType> leaning{first.transpose() * e3, {0.3, -0.2, 1.5}};
  attitude = first;
  const auto fallen = top.reference(leaning, attitude, 3);
  EXPECT_NEAR(order_of(top, leaning, {first, e3}, fallen, {attitude, e3}, 3), 4, 0.1);
}

TEST(RungeKutta, LeavesTheGroupWhichStepsOfOursDoNot) {
  RigidBody body;
  State<SO3> turning;
  turning.momentum << 0.3, 2.5, 0.4;
  const Matrix<double, 3, 3> unit = Matrix<double, 3, 3>::Identity();
  const auto off = [&](StepKind kind) {
    body.h = 0.1;
    const auto integrator = make_integrator(body, turning, unit, {.fixed = kind});
    for (int k = 0; k < 10'000; ++k) EXPECT_TRUE(integrator->advance().converged());
    const auto& a = integrator->point().configuration;
    return (a.transpose() * a - unit).norm();
  };
  EXPECT_GT(off(StepKind::runge_kutta), 1e-3);
  EXPECT_LT(off(StepKind::splitting), 1e-14);
  EXPECT_LT(off(StepKind::variational), 1e-14);
}

TEST(RungeKutta, StopsBeforeNumbersThatAreNotFinite) {
  const Kepler kepler;
  const auto integrator = runge_kutta(kepler, {{1e-200, 0}, {0, 0}}, {{1e-200, 0}, {1e-200, 0}}, 0.1);
  EXPECT_EQ(integrator->advance().status, SolveStatus::not_finite);
  EXPECT_EQ(integrator->point().index, 0);
  EXPECT_EQ(integrator->point().state.object(0), 1e-200);
}

TEST(RungeKutta, NeedsRates) {
  EXPECT_THROW(make_integrator(RollingDisk{}, {}, {}, {.fixed = StepKind::runge_kutta}), std::invalid_argument);
}

}  // namespace
}  // namespace integrators_runge_kutta_tests
