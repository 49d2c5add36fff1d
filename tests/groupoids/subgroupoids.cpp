// Constraint sets that are subgroupoids give the dynamics of the subgroupoid; others do not close. [G] Remark 3.6
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace lagroid;

namespace groupoids_subgroupoids_tests {
namespace {

/// A body on an axle: SO(2) as the wide subgroupoid of SO(3) that leaves e3 where it is.
struct OnAnAxle : System<OnAnAxle, SO3, /*arrow constraints*/ 2> {
  double h = 0.1;
  RigidBody body;
  template <class S> S lagrangian(const Matrix<S, 3, 3>& g) const {
    return rotational_action(g, body.inertia, h, body.rotation) + twist(g(1, 0));
  }
  template <class S> Vector<S, 2> constraint(const Matrix<S, 3, 3>& g) const { return {g(0, 2), g(1, 2)}; }
  /// Not quadratic in the angle, so that there is something to get wrong.
  template <class S> S twist(const S& sine) const { return sine * sine * sine * 0.7; }
};
struct Wheel : System<Wheel, SO2> {
  double h = 0.1;
  OnAnAxle embedding;
  template <class S> S lagrangian(const Matrix<S, 2, 2>& g) const {
    const S angle = SO2::log(g)(0);
    return angle * angle * (0.5 * embedding.body.inertia(2) / h) + embedding.twist(g(1, 0));
  }
};
TEST(WideSubgroupoid, AnArrowConstraintGivesItsDynamics) {
  const double momentum = 1.3;
  auto above = laws::detail::newton_integrator(OnAnAxle{}, State<SO3>{{}, {0, 0, momentum}});
  auto below = laws::detail::newton_integrator(Wheel{}, State<SO2>{{}, Vector<double, 1>(momentum)});
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(above.advance().converged());
    ASSERT_TRUE(below.advance().converged());
    const Matrix<double, 3, 3>& g = above.point().step.arrow;
    EXPECT_LT((g.topLeftCorner<2, 2>() - below.point().step.arrow).norm(), 1e-13);
    EXPECT_NEAR(above.point().state.momentum(2), below.point().state.momentum(0), 1e-13);
  }
}

/// A bead on a circle: the full subgroupoid of Pair(R^2) over C^{-1}(0), and Pair of the circle by its angle.
struct Bead : System<Bead, Pair<2>, 0, /*object constraints*/ 1> {
  double h = 0.1;
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const {
    return (g.target - g.source).squaredNorm() * (0.5 / h) - (g.source(1) + g.target(1)) * (0.5 * h);
  }
  template <class S> Vector<S, 1> object_constraint(const Vector<S, 2>& q) const {
    return Vector<S, 1>((q.squaredNorm() - 1.0) * 0.5);
  }
};
struct BeadByAngle : System<BeadByAngle, Pair<1>> {
  double h = 0.1;
  template <class S> static Vector<S, 2> place(const S& angle) {
    using std::cos, std::sin;
    return {sin(angle), -cos(angle)};
  }
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
    Bead bead;
    bead.h = h;
    return bead.lagrangian(PairArrow<S, 2>{place(g.source(0)), place(g.target(0))});
  }
};
TEST(FullSubgroupoid, AnObjectConstraintGivesItsDynamics) {
  const double angle = 0.9;
  const double speed = 0.8;
  const Vector<double, 2> tangent(std::cos(angle), std::sin(angle));
  auto above = laws::detail::newton_integrator(Bead{}, State<Pair<2>>{BeadByAngle::place(angle), speed * tangent});
  auto below = laws::detail::newton_integrator(BeadByAngle{},
                                               State<Pair<1>>{Vector<double, 1>(angle), Vector<double, 1>(speed)});
  for (int k = 0; k < 200; ++k) {
    ASSERT_TRUE(above.advance().converged());
    ASSERT_TRUE(below.advance().converged());
    EXPECT_LT((above.point().state.object - BeadByAngle::place(below.point().state.object(0))).norm(), 1e-11) << k;
  }
}

TEST(NoSubgroupoid, TheProductOfTwoRollingArrowsDoesNotRoll) {
  PlateBall plate;
  plate.h = 0.1;
  State<PlateBall::GroupoidType> start;
  std::get<0>(start.object) << 0.3, -0.2;
  start.momentum << 0.9, 0.2, 0.6, -0.4, 0.8;
  auto integrator = laws::detail::newton_integrator(plate, start);
  ASSERT_TRUE(integrator.advance().converged());
  const auto first = integrator.point().step.arrow;
  ASSERT_TRUE(integrator.advance().converged());
  const auto second = integrator.point().step.arrow;
  EXPECT_LT(plate.constraint(first).norm(), 1e-14);
  EXPECT_LT(plate.constraint(second).norm(), 1e-14);
  // Not even with the constraint of a step twice as long.
  const auto both = plate.groupoid.compose(first, second);
  EXPECT_GT(plate.constraint(both).norm(), 1e-6);
  plate.h *= 2;
  EXPECT_GT(plate.constraint(both).norm(), 1e-6);
}

}  // namespace
}  // namespace groupoids_subgroupoids_tests
