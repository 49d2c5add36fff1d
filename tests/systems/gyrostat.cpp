// The body with three rotors: its continuous motion, its order, what it keeps.

#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/rotations/gyrostat.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace lagroid;

namespace systems_gyrostat_tests {
namespace {

using G = Gyrostat::GroupoidType;

State<G> start() {
  State<G> s;
  s.momentum << 0.3, 1.5, 0.4, 0.2, -0.1, 0.3;
  return s;
}

struct End {
  Matrix<double, 3, 3> attitude;
  State<G> state;
};

End integrated(Gyrostat system, double time, long steps) {
  system.h = time / double(steps);
  const State<G> from = start();
  FixedStepIntegrator<Gyrostat> integrator(system, from, system.groupoid.unit(from.object),
                                           std::make_unique<NewtonStep<Gyrostat>>());
  for (long i = 0; i < steps; ++i) EXPECT_TRUE(integrator.advance().converged());
  return {std::get<0>(integrator.point().configuration), integrator.point().state};
}

double distance(const End& end, const Matrix<double, 3, 3>& attitude, const State<G>& state) {
  return (end.attitude - attitude).norm() + (end.state.momentum - state.momentum).norm();
}

TEST(Gyrostat, FollowsItsContinuousMotionWithOrderTwo) {
  for (const auto rotation : {RotationMap::exponential, RotationMap::cayley}) {
    Gyrostat system;
    system.rotation = rotation;
    Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
    const State<G> reference = system.reference(start(), attitude, 4);
    const double order = laws::measured_order(
        [&](long steps) { return distance(integrated(system, 4, steps), attitude, reference); }, 100);
    EXPECT_NEAR(order, 2, 0.1);
  }
}

/// With rotors that are held fast (their momenta J w, and moments that go to zero) it is a rigid body.
TEST(Gyrostat, IsARigidBodyWithoutRotors) {
  Gyrostat system;
  system.rotors = {1e-12, 1e-12, 1e-12};
  RigidBody body;
  body.inertia = system.inertia;
  Matrix<double, 3, 3> with = Matrix<double, 3, 3>::Identity();
  Matrix<double, 3, 3> without = with;
  State<G> from;
  from.momentum << 0.3, 1.5, 0.4, 0, 0, 0;
  const State<G> a = system.reference(from, with, 5);
  const State<SO3> b = body.reference({{}, Vector<double, 3>(0.3, 1.5, 0.4)}, without, 5);
  EXPECT_LT((with - without).norm(), 1e-10);
  EXPECT_LT((a.momentum.head<3>() - b.momentum).norm(), 1e-10);
}

TEST(Gyrostat, KeepsItsMomentaAndItsRates) {
  const Gyrostat system;
  const State<G> from = start();
  const End end = integrated(system, 20, 400);
  EXPECT_LT((end.state.momentum.tail<3>() - from.momentum.tail<3>()).norm(), 2e-14);
  EXPECT_LT((end.attitude * end.state.momentum.head<3>() - from.momentum.head<3>()).norm(), 1e-14);
  // <mu, (w, t)> is twice the energy, and the rates are those of l: M = I w + j, j = J (w + t).
  const Vector<double, 6> v = system.velocity(from.momentum);
  const Vector<double, 3> w = v.head<3>();
  const Vector<double, 3> j = system.rotors.cwiseProduct(Vector<double, 3>(w + v.tail<3>()));
  EXPECT_LT((system.inertia.cwiseProduct(w) + j - from.momentum.head<3>()).norm(), 1e-15);
  EXPECT_LT((j - from.momentum.tail<3>()).norm(), 1e-15);
  EXPECT_NEAR(0.5 * from.momentum.dot(v), system.energy(from), 1e-15);
}

/// A wheel that spins fast holds the body's middle axis, about which it could not turn without.
TEST(Gyrostat, ASpinningWheelSteadiesTheMiddleAxis) {
  const auto wander = [](double wheel) {
    Gyrostat system;
    State<G> from;
    from.momentum << 1e-3, 2 + wheel, 1e-3, 0, wheel, 0;
    system.h = 0.05;
    FixedStepIntegrator<Gyrostat> integrator(system, from, system.groupoid.unit(from.object),
                                             std::make_unique<NewtonStep<Gyrostat>>());
    double largest = 0;
    for (int i = 0; i < 2000; ++i) {
      EXPECT_TRUE(integrator.advance().converged());
      const Vector<double, 6>& mu = integrator.point().state.momentum;
      largest = std::max(largest, std::hypot(mu(0), mu(2)));
    }
    return largest;
  };
  EXPECT_GT(wander(0), 1);
  EXPECT_LT(wander(4), 0.01);
}

}  // namespace
}  // namespace systems_gyrostat_tests
