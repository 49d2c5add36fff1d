// Nonholonomic mechanics against vakonomic: the same Lagrangian and constraints, another principle.
#include "../../support/integrating.hpp"
#include "../../support/turning_plate.hpp"

#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace lagroid;

namespace integrators_principles_tests {
namespace {

/// The same Lagrangian and the same constraints, the other principle.
struct VakonomicBall : RollingBall {
  static constexpr auto principle = Principle::vakonomic;
  Step<VakonomicBall> first_guess(const State<Plane>& s) const { return {RollingBall::first_guess(s).arrow, {0, 0}}; }
};
static_assert(Variational<VakonomicBall>);

/// The same ball in a scene of bodies.
TEST(RollingBall, VakonomicPathsAreThoseOfAScene) {
  namespace mb = multibody;
  VakonomicBall system;
  static_cast<RollingBall&>(system) = ball_on_turning_plate();
  system.h = 0.02;
  const auto start = start_of(system);
  State<Plane> from = start;
  const Vector<double, 2> lambda(0.3, -0.2);
  from.momentum += system.annihilator(start.object) * lambda;
  constexpr int steps = 100;
  const auto end = integrate(system, from, steps);
  mb::Scene scene;
  const double inertia = system.inertia();
  const mb::Quaternion turned = mb::Quaternion(1, 0.2, 0.3, 0.4).normalized();
  const mb::Body ball =
      scene.rigid_body(system.mass, {inertia, inertia, inertia}, {0.3, -0.2, system.radius}, turned, {0.4, 0.1, 0},
                       SO3::from_quaternion(turned).transpose() * system.angular_velocity(start));
  scene.add(mb::Vakonomic<mb::Rolling>{{{ball.centre}, {ball.attitude}, system.radius, system.plate_rate},
                                       {lambda(1), lambda(0)}});
  mb::Multibody motion(std::move(scene), system.h);
  for (int k = 0; k < steps; ++k) ASSERT_TRUE(motion.advance().converged()) << k;
  const mb::Vec at = motion.configuration()(motion(ball.centre));
  EXPECT_LT((at.head<2>() - std::get<0>(end.state.object)).norm(), 1e-11);
  EXPECT_LT((motion.state().momentum[0].head<2>() - end.state.momentum.head<2>()).norm(), 1e-11);
  EXPECT_LT(motion.constraint_residual(), 1e-14);
}

TEST(RollingBall, VakonomicPathsAreOthers) {
  const RollingBall rolling = ball_on_turning_plate();
  VakonomicBall optimal;
  static_cast<RollingBall&>(optimal) = rolling;
  const auto start = start_of(rolling);
  const auto distance = [&](double h, const State<Plane>& from) {
    RollingBall mechanics = rolling;
    VakonomicBall control = optimal;
    mechanics.h = control.h = h;
    const long steps = std::lround(3 / h);
    const auto a = integrate(mechanics, start, steps);
    const auto b = integrate(control, from, steps);
    EXPECT_LT(constraint_values(control, b.step.arrow).norm(), 1e-13);
    return std::abs(position_of(a.state) - position_of(b.state));
  };
  // Both keep the same constraints and start with the same velocity, which leaves the vakonomic path its multipliers.
  for (const double l1 : {-0.5, 0.0, 0.5})
    for (const double l2 : {-0.5, 0.0, 0.5}) {
      State<Plane> from = start;
      from.momentum += rolling.annihilator(start.object) * Vector<double, 2>(l1, l2);
      const double coarse = distance(0.02, from);
      EXPECT_GT(coarse, 0.1) << l1 << ' ' << l2;
      EXPECT_NEAR(distance(0.01, from), coarse, 0.02 * coarse) << "no matter of the step";
    }
}

/// A particle in the plane, attracted to the origin and held to a line by a constraint on its velocity, which is
/// integrable.
template <Principle P> struct OnALine : System<OnALine<P>, Pair<2>, 1> {
  static constexpr auto principle = P;
  double h = 0.05;
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const {
    const Vector<S, 2> d = g.target - g.source;
    const Vector<S, 2> m = (g.source + g.target) * 0.5;
    return d.squaredNorm() * (0.5 / h) - m.squaredNorm() * (0.5 * h);
  }
  template <class S> Vector<S, 1> constraint(const PairArrow<S, 2>& g) const {
    const Vector<S, 2> d = g.target - g.source;
    return Vector<S, 1>(d(1) - d(0) * 0.5);
  }
};

TEST(Principles, AgreeWhereConstraintsAreIntegrable) {
  const State<Pair<2>> start{{0.3, 0.4}, {1, 0.5}};
  const auto mechanics = integrate(OnALine<Principle::nonholonomic>{}, start, 100);
  const auto control = integrate(OnALine<Principle::vakonomic>{}, start, 100);
  EXPECT_LT((mechanics.state.object - control.state.object).norm(), 1e-12);
  EXPECT_GT((mechanics.state.object - start.object).norm(), 0.1);
}

}  // namespace
}  // namespace integrators_principles_tests
