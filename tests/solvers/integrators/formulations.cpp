// Systems on groups as users write them, and in other formulations: rigid bodies by momenta and by quaternions, the
// unicycle on pairs of poses.
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include "../../support/broken.hpp"
#include "../boundary/control_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace lagroid;

namespace integrators_formulations_tests {
namespace {

/// The free rigid body, as a user would write it.
struct FreeBody : GroupControl<FreeBody, SO3> {
  Vector3 inertia{1, 2, 3};
  template <class S> S l(const Vector<S, 3>& w) const {
    return (w(0) * w(0) * inertia(0) + w(1) * w(1) * inertia(1) + w(2) * w(2) * inertia(2)) * 0.5;
  }
  Control<3, 0> control(const Vector3& mu) const { return {mu.cwiseQuotient(inertia), {}}; }
};
RigidBody rigid_body(const FreeBody& body) {
  RigidBody out;
  out.h = body.h;
  out.inertia = body.inertia;
  out.rotation = body.map;
  return out;
}
const Vector3 tumbling(0.3, 1.5, 0.4);

TEST(RigidBody, IsThatOfTheLiePoissonEquations) {
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    FreeBody body;
    body.h = 0.05;
    body.map = map;
    EXPECT_LT(lie_poisson_difference(rigid_body(body), body, tumbling), 1e-12);
    EXPECT_LT(lie_poisson_difference(body, body, tumbling), 1e-12);
  }
}

TEST(LiePoissonStep, SaysWhyItFails) {
  FreeBody body;
  EXPECT_EQ(lie_poisson_step(body, Vector3(1, std::nan(""), 0)).status, SolveStatus::not_finite);
  EXPECT_EQ(lie_poisson_step(body, tumbling, 1).status, SolveStatus::not_converged);
}

/// A car that pays for rolling and for turning, and says nothing of its extremals.
struct Car : GroupControl<Car, SE2, /*constraints*/ 1> {
  template <class S> S l(const Vector<S, 3>& xi) const { return (xi(0) * xi(0) + xi(1) * xi(1)) * 0.5; }
  template <class S> Vector<S, 1> psi(const Vector<S, 3>& xi) const { return Vector<S, 1>(xi(2)); }
};

TEST(GroupControl, NeedsNoMoreThanCostAndConstraint) {
  Car car;
  car.h = 0.05;
  const auto quantities = car.quantities();
  ASSERT_EQ(quantities.size(), 1U);
  const Vector3 start(0.7, -0.9, 0.6);
  auto integrator = walk(car, start);
  for (int k = 0; k < 300; ++k) {
    ASSERT_TRUE(integrator.advance().converged());
    const auto& point = integrator.point();
    Vector3 now;
    quantities[0].evaluate(point, now.data());
    EXPECT_LT((now - start).norm(), 1e-12);
    EXPECT_LT(std::abs(car.velocity(point.step.arrow)(2)), 1e-14);
  }
  EXPECT_GT((integrator.point().state.momentum - start).norm(), 0.1);
}

/// The unit quaternions (w, x, y, z), with the algebra of the rotations that they stand for.
struct UnitQuaternions : LieGroupoid<UnitQuaternions, 3> {
  template <class S> using Arrow = Vector<S, 4>;
  template <class S> using Object = Vector<S, 0>;
  template <class S> static Vector<S, 0> source(const Vector<S, 4>&) { return {}; }
  template <class S> static Vector<S, 0> target(const Vector<S, 4>&) { return {}; }
  template <class S> static Vector<S, 4> unit(const Vector<S, 0>&) { return {S(1), S(0), S(0), S(0)}; }
  template <class S> static Vector<S, 4> inverse(const Vector<S, 4>& q) { return {q(0), -q(1), -q(2), -q(3)}; }
  template <class S> static Vector<S, 4> multiply(const Vector<S, 4>& p, const Vector<S, 4>& q) {
    return {
        p(0) * q(0) - p(1) * q(1) - p(2) * q(2) - p(3) * q(3), p(0) * q(1) + p(1) * q(0) + p(2) * q(3) - p(3) * q(2),
        p(0) * q(2) + p(2) * q(0) + p(3) * q(1) - p(1) * q(3), p(0) * q(3) + p(3) * q(0) + p(1) * q(2) - p(2) * q(1)};
  }
  /// (cos(a/2), sin(a/2) v/a), a = |v|.
  template <class S> static Vector<S, 4> tau(const Vector<S, 0>&, const Vector<S, 3>& v) {
    const S x = v.squaredNorm() * 0.25;
    const S s = stumpff<1>(x) * 0.5;
    return {stumpff<0>(x), s * v(0), s * v(1), s * v(2)};
  }
  template <class S> static Vector<S, 3> tau_inverse(const Vector<S, 4>& q) {
    return q.template tail<3>() * angle_ratio<0>(q(0));
  }
  static Vector<double, 4> project(const Vector<double, 4>& q) { return q.normalized(); }
  static std::string name() { return "unit quaternions"; }
};

/// A system on SO(3), on the quaternions.
template <class Body> struct OnQuaternions : System<OnQuaternions<Body>, UnitQuaternions, Body::constraints> {
  Body body;
  double h = body.h;

  explicit OnQuaternions(const Body& b) : body(b) {}

  template <class S> Vector<S, 3> velocity(const Vector<S, 4>& q) const {
    const S ratio = body.map == Retraction::exponential ? angle_ratio<0>(q(0)) : 2.0 / q(0);
    return q.template tail<3>() * (ratio * (1 / h));
  }
  template <class S> S lagrangian(const Vector<S, 4>& q) const { return body.l(velocity(q)) * h; }
  template <class S>
  Vector<S, Body::constraints> constraint(const Vector<S, 4>& q) const requires(Body::constraints > 0) {
    return body.psi(velocity(q)) * h;
  }
};

/// How far trajectories on rotation matrices are from those on quaternions, after 300 steps.
template <class Sys, class Body>
double quaternion_difference(const Sys& system, const Body& body, const Vector3& start) {
  auto on_matrices = walk(system, start);
  auto on_quaternions = walk(OnQuaternions<Body>(body), start);
  double difference = 0;
  for (int k = 0; k < 300; ++k) {
    EXPECT_TRUE(on_matrices.advance().converged());
    EXPECT_TRUE(on_quaternions.advance().converged());
    const auto& p = on_matrices.point();
    const auto& q = on_quaternions.point();
    difference = std::max({difference, (p.state.momentum - q.state.momentum).norm(),
                           (p.configuration - SO3::from_quaternion(q.configuration)).norm()});
    if constexpr (Sys::constraints > 0)
      difference = std::max(difference, (p.step.multipliers - q.step.multipliers).norm());
  }
  return difference;
}

TEST(Quaternions, TurnAsMatricesDo) {
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    FreeBody body;
    body.h = 0.05;
    body.map = map;
    EXPECT_LT(quaternion_difference(rigid_body(body), body, tumbling), 1e-12);
    Case<AttitudeControl> control;
    control.system.h = 0.05;
    control.system.map = map;
    EXPECT_LT(quaternion_difference(control.system, control.system, control.momentum), 1e-12);
    FreeBody other = body;
    other.inertia(2) += 1e-5;
    EXPECT_GT(quaternion_difference(rigid_body(other), body, tumbling), 1e-8);
  }
}

/// The unicycle unreduced, on pairs of poses (x, y, heading).
struct PosedUnicycle : System<PosedUnicycle, Pair<3>, /*arrow constraints*/ 2> {
  Unicycle unicycle;
  double h = unicycle.h;

  explicit PosedUnicycle(const Unicycle& u) : unicycle(u) {}

  template <class S> Matrix<S, 3, 3> between(const PairArrow<S, 3>& g) const {
    using std::cos, std::sin;
    const Vector<S, 3> d = g.target - g.source;
    const S c = cos(g.source(2));
    const S s = sin(g.source(2));
    return SE2::homogeneous<S>(SO2::exp(Vector<S, 1>(d(2))), {c * d(0) + s * d(1), c * d(1) - s * d(0)});
  }
  template <class S> S lagrangian(const PairArrow<S, 3>& g) const { return unicycle.lagrangian(between(g)); }
  template <class S> Vector<S, 2> constraint(const PairArrow<S, 3>& g) const { return unicycle.constraint(between(g)); }
};

TEST(Poses, MoveAsTheirReductionDoes) {
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    Case<Unicycle> start;
    start.system.h = 0.05;
    start.system.map = map;
    auto reduced = walk(start.system, start.momentum);
    const Vector3 momentum(start.momentum(1), start.momentum(2), start.momentum(0));
    auto posed = walk(PosedUnicycle(start.system), State<Pair<3>>{Vector3::Zero(), momentum});
    for (int k = 0; k < 300; ++k) {
      ASSERT_TRUE(reduced.advance().converged());
      ASSERT_TRUE(posed.advance().converged());
      const auto& p = reduced.point();
      const Vector3& q = posed.point().state.object;
      const Vector3& mu = posed.point().state.momentum;
      EXPECT_LT((p.configuration.topRightCorner<2, 1>() - q.head<2>()).norm(), 1e-12) << k;
      EXPECT_LT(std::abs(std::remainder(SE2::log(p.configuration)(0) - q(2), 2 * std::numbers::pi)), 1e-12) << k;
      EXPECT_LT((p.configuration.topLeftCorner<2, 2>() * p.state.momentum.tail<2>() - mu.head<2>()).norm(), 1e-12);
      EXPECT_NEAR(p.state.momentum(0), mu(2), 1e-12) << k;
      EXPECT_LT((p.step.multipliers - posed.point().step.multipliers).norm(), 1e-12) << k;
    }
  }
}

TEST(AttitudeControl, TheForbiddenAxisIsOneOfSymmetryForEqualWeightsOnly) {
  AttitudeControl system;
  system.h = 0.1;
  const auto draw = [] { return State<SO3>{{}, laws::draw_vector<3>(1.5)}; };
  AttitudeControl uneven = system;
  uneven.weights(0) = 1.2;
  EXPECT_TRUE(uneven.symmetries().empty());
  const auto broken = laws::noether_laws(uneven, system.symmetries(), draw);
  EXPECT_TRUE(laws::seen_broken(broken.law("axial momentum M.n is a symmetry"))) << broken;
}

}  // namespace
}  // namespace integrators_formulations_tests
