// Flows of the parts of split systems, and flows that break their laws.
#include "problems.hpp"

#include "../../../support/broken.hpp"

#include <lagroid/solvers/testing/splitting_laws.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/driven_body.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/moser_veselov.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lagroid::splitting_tests::flows_tests {
namespace {

static_assert(SplitSystem<Pendulum> && SplitSystem<Kepler> && SplitSystem<RigidBody> && SplitSystem<HeavyTop>);
static_assert(SplitSystem<SphericalPendulum> && NystromSystem<SphericalPendulum> && !NystromSystem<RigidBody>);
static_assert(!SplitSystem<DampedPendulum> && !SplitSystem<DrivenBody>);  // flows that know nothing of the forces
static_assert(!SplitSystem<MoserVeselov>);

State<Pair<1>> draw_pendulum() { return {laws::draw_vector<1>(3.0), laws::draw_vector<1>(3.0)}; }

State<Pair<2>> draw_orbit() {
  const Vector<double, 4> wobble = 0.2 * laws::draw_vector<4>(1.0);
  return {{1 + wobble(0), wobble(1)}, {wobble(2), 1 + wobble(3)}};
}

State<SO3> draw_body() {
  State<SO3> s;
  s.momentum = laws::draw_vector<3>(3.0);
  return s;
}

State<HeavyTop::GroupoidType> draw_top() {
  const Vector<double, 3> v = laws::draw_vector<3>(1.0) + Vector<double, 3>(0.01, -0.02, 0.03);
  return {v.normalized(), laws::draw_vector<3>(1.5)};
}

TEST(Flows, AreThoseOfTheParts) {
  const auto pendulum = laws::splitting_laws(Pendulum{}, draw_pendulum);
  EXPECT_TRUE(pendulum.holds()) << pendulum;
  const auto orbit = laws::splitting_laws(Kepler{}, draw_orbit, 0.3);
  EXPECT_TRUE(orbit.holds()) << orbit;
  const auto top = laws::splitting_laws(asymmetric_top(), draw_top);
  EXPECT_TRUE(top.holds()) << top;
}

TEST(Flows, OfBodiesOfEveryShape) {
  // Every order of the moments, and symmetric ones.
  for (const Vector<double, 3>& inertia :
       {Vector<double, 3>(1, 2, 2.5), Vector<double, 3>(2, 1, 2.5), Vector<double, 3>(2.5, 2, 1),
        Vector<double, 3>(1, 2.5, 2), Vector<double, 3>(1, 1, 0.5), Vector<double, 3>(1, 1, 1)}) {
    RigidBody body;
    body.inertia = inertia;
    const auto report = laws::splitting_laws(body, draw_body);
    EXPECT_TRUE(report.holds()) << inertia.transpose() << '\n' << report;
  }
}

/// A kick the wrong way; a drift that loses a thousandth of the momentum; a rotation by its linear part.
struct KickedBack : Kepler {
  template <int Part, class S> FlowOf<Pair<2>, S> flow(double t, const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    return Kepler::flow<Part, S>(Part == 0 ? -t : t, q, p);
  }
};

template <class Derived> struct Altered : System<Derived, SO3> {
  double h = 0.01;
  template <class S> S lagrangian(const Matrix<S, 3, 3>& g) const {
    RigidBody body;
    body.h = h;
    return body.lagrangian(g);
  }
  static constexpr int parts = RigidBody::parts;
};

struct TurnedByEuler : Altered<TurnedByEuler> {
  template <int Part, class S> FlowOf<SO3, S> flow(double t, const Vector<S, 0>& q, const Vector<S, 3>& mu) const {
    auto out = RigidBody{}.flow<Part, S>(t, q, mu);
    if (Part == 0) out.momentum_change = mu.cross(SO3::log(out.arrow));
    return out;
  }
};

struct TurnedBack : Altered<TurnedBack> {
  template <int Part, class S> FlowOf<SO3, S> flow(double t, const Vector<S, 0>& q, const Vector<S, 3>& mu) const {
    auto out = RigidBody{}.flow<Part, S>(t, q, mu);
    out.arrow.transposeInPlace();
    return out;
  }
};

TEST(BrokenFlows, FailTheLawsTheyBreak) {
  const auto kicked = laws::splitting_laws(KickedBack{}, draw_orbit, 0.3);
  EXPECT_TRUE(laws::seen_broken(kicked.law("the parts add up to the system"))) << kicked;
  EXPECT_TRUE(kicked.law("part 0 is Poisson").holds()) << kicked;
  const auto rubbed = laws::splitting_laws(Rubbed{}, draw_orbit, 0.3);
  EXPECT_TRUE(laws::seen_broken(rubbed.law("part 1 is Poisson"))) << rubbed;
  const auto euler = laws::splitting_laws(TurnedByEuler{}, draw_body);
  EXPECT_TRUE(laws::seen_broken(euler.law("part 0 is a flow"))) << euler;
  EXPECT_TRUE(laws::seen_broken(euler.law("part 0 is Poisson"))) << euler;
  const auto back = laws::splitting_laws(TurnedBack{}, draw_body);
  EXPECT_TRUE(laws::seen_broken(back.law("the parts add up to the system"))) << back;
}

/// The angle of the rod from its length, and of the momentum from its tangent plane.
TEST(Flows, OfTheSphericalPendulumStayOnTheSphere) {
  SphericalPendulum system;
  system.h = 0.1;
  system.length = 0.3;
  auto run = make(system, {{0, 0, -0.3}, {0.5, 0.2, 0}}, splittings::srkn14);
  for (int k = 0; k < 100'000; ++k) ASSERT_TRUE(run.advance().converged());
  const auto& z = run.point().state;
  EXPECT_NEAR(z.object.norm(), 0.3, 2e-16);
  EXPECT_LT(std::abs(z.object.dot(z.momentum)), 1e-15 * z.momentum.norm());
}

template <class Sys, int N> double largest_gradient_defect(const Sys& system) {
  double most = 0;
  for (int k = 0; k < 20; ++k) {
    Vector<Dual<double>, N> q;
    for (int i = 0; i < N; ++i) q(i) = 0.3 + 0.1 * k + 0.2 * i;
    Vector<double, N> at;
    for (int i = 0; i < N; ++i) at(i) = q(i).value;
    const Vector<double, N> gradient = system.gradient(at);
    for (int i = 0; i < N; ++i) {
      q(i).derivative = 1;
      most = std::max(most, std::abs(system.potential(q).derivative - gradient(i)) / gradient.norm());
      q(i).derivative = 0;
    }
  }
  return most;
}

TEST(Gradients, AreThoseOfThePotentials) {
  EXPECT_LT((largest_gradient_defect<Kepler, 2>({})), 1e-14);
  EXPECT_LT((largest_gradient_defect<Pendulum, 1>({})), 1e-14);
}

}  // namespace
}  // namespace lagroid::splitting_tests::flows_tests
