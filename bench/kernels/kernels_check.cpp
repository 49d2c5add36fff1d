// The hand-written kernels compute what the framework computes.
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/lie_group/integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/chain_rattle.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>

#include "../../tests/support/allocation_counter.hpp"
#include "../cases/boundary_case.hpp"
#include "../cases/chain_case.hpp"
#include "../cases/lie_newton_case.hpp"
#include "../cases/pendulum_case.hpp"
#include "kepler.hpp"
#include "plate_ball/plate_ball.hpp"
#include "plate_ball/plate_ball_derivatives.hpp"
#include "plate_ball/plate_ball_ipopt.hpp"
#include "plate_ball/plate_ball_newton.hpp"
#include "rigid_body_derivatives.hpp"
#include "so3_cayley.hpp"
#include "spherical_pendulum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

using namespace lagroid;
using bench::boundary_case;
using bench::BoundaryCase;
using bench::nodes;
using bench::parameters;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using kernels::HandPlateBall;
using kernels::HandRigidBody;

namespace {

constexpr int steps = 200;
constexpr double close = 1e-12;

template <class Sys>
FixedStepIntegrator<Sys> framework(const Sys& system, const State<typename Sys::GroupoidType>& start,
                                   const ArrowOf<typename Sys::GroupoidType>& configuration) {
  return {system, start, configuration, std::make_unique<NewtonStep<Sys>>()};
}

/// How far the step equations are from solved, as a multiple of their round-off.
template <class Sys>
double roundoff_ratio(const Sys& system, const State<typename Sys::GroupoidType>& state, const Step<Sys>& step) {
  Scaling<StepEquations<Sys>::size> scaling;
  return ScaledResidual<Sys>(system, state, step, two_sided(system, step.arrow, step.multipliers), scaling, true)
      .roundoff_ratio;
}

template <int N, int M> double largest(const TwoSided<N, M>& derivative) {
  double size = std::max({std::abs(derivative.value), derivative.source_gradient.cwiseAbs().maxCoeff(),
                          derivative.target_gradient.cwiseAbs().maxCoeff(), derivative.mixed.cwiseAbs().maxCoeff()});
  if constexpr (M > 0)
    size =
        std::max({size, derivative.constraint.cwiseAbs().maxCoeff(), derivative.constraint_source.cwiseAbs().maxCoeff(),
                  derivative.constraint_target.cwiseAbs().maxCoeff()});
  return size;
}

template <int N, int M> TwoSided<N, M> difference(const TwoSided<N, M>& a, const TwoSided<N, M>& b) {
  return {{a.value - b.value, a.source_gradient - b.source_gradient, a.target_gradient - b.target_gradient,
           a.constraint - b.constraint},
          a.mixed - b.mixed,
          a.constraint_source - b.constraint_source,
          a.constraint_target - b.constraint_target};
}

template <class Kernel> class RigidBodyKernel : public ::testing::Test {};
using RigidBodyKernels =
    ::testing::Types<kernels::So3Cayley<0>, kernels::So3Cayley<1>, kernels::So3Cayley<2>, kernels::So3Cayley<4>>;
TYPED_TEST_SUITE(RigidBodyKernel, RigidBodyKernels);

TYPED_TEST(RigidBodyKernel, IsTheFramework) {
  RigidBody system;
  system.h = 0.02;
  system.rotation = RotationMap::cayley;
  State<SO3> start;
  start.momentum << 0.4, 1.9, -1.1;
  const Matrix3d attitude = SO3::exp(Vector3d(0.3, -0.2, 0.5));
  auto peer = framework(system, start, attitude);
  TypeParam kernel(system.h, system.inertia, start.momentum, attitude);
  const Vector3d spatial = attitude * start.momentum;
  for (int k = 0; k < steps; ++k) {
    const State<SO3> before{{}, kernel.momentum()};
    ASSERT_TRUE(peer.advance().converged());
    kernel.step();
    ASSERT_LT((kernel.momentum() - peer.point().state.momentum).norm(), close) << k;
    ASSERT_LT((kernel.attitude() - peer.point().configuration).norm(), close) << k;
    ASSERT_LT(roundoff_ratio(system, before, Step<RigidBody>{SO3::cayley(kernel.solution()), {}}), 4) << k;
    ASSERT_LT((kernel.attitude() * kernel.momentum() - spatial).norm(), 1e-13) << k;
  }
}

TEST(RigidBodyDerivatives, AreTheAutomaticOnes) {
  HandRigidBody hand;
  hand.h = 0.1;
  hand.rotation = RotationMap::cayley;
  for (const Vector3d& x : {Vector3d(0.1, -0.2, 0.3), Vector3d(1.1, 0.4, -0.7), Vector3d(1e-3, 0, 2e-3)}) {
    const Matrix3d g = SO3::exp(x);
    const auto expected = automatic_two_sided<RigidBody>(hand, g, {});
    EXPECT_LT(largest(difference(hand.two_sided(g, {}), expected)), 1e-13 * std::max(1.0, largest(expected)));
  }
}

template <class Kernel> class PlateBallKernel : public ::testing::Test {};
using PlateBallKernels =
    ::testing::Types<kernels::PlateBall<0>, kernels::PlateBall<2>, kernels::PlateBall<4>, kernels::PlateBallNewton<0>,
                     kernels::PlateBallNewton<2>, kernels::PlateBallNewton<4>>;
TYPED_TEST_SUITE(PlateBallKernel, PlateBallKernels);

TYPED_TEST(PlateBallKernel, IsTheFramework) {
  using G = PlateBall::GroupoidType;
  for (const bool rotating : {false, true}) {
    PlateBall system;
    system.h = 0.02;
    system.radius = 1.3;
    system.plate_rate = rotating ? 0.7 : 0;
    system.spin = 0.4;
    const Vector2d position(0.3, -0.2);
    const Vector2d linear(0.9, 0.2);
    const Vector3d body(0.6, -0.4, 0.8);
    State<G> start;
    std::get<0>(start.object) = position;
    start.momentum << linear, body;
    auto peer = framework(system, start, {PairArrow<double, 2>{position, position}, Matrix3d::Identity()});
    TypeParam kernel({system.h, system.radius, system.plate_rate, system.spin},
                     {position, linear, body, Matrix3d::Identity()});
    for (int k = 0; k < steps; ++k) {
      State<G> before;
      std::get<0>(before.object) = kernel.position();
      before.momentum << kernel.linear_momentum(), kernel.body_momentum();
      const Matrix3d attitude = kernel.attitude();
      ASSERT_TRUE(peer.advance().converged());
      kernel.step();
      const auto& point = peer.point();
      ASSERT_LT((kernel.position() - std::get<0>(point.state.object)).norm(), close) << k;
      ASSERT_LT((kernel.linear_momentum() - point.state.momentum.head<2>()).norm(), close) << k;
      ASSERT_LT((kernel.body_momentum() - point.state.momentum.tail<3>()).norm(), close) << k;
      ASSERT_LT((kernel.attitude() - std::get<1>(point.configuration)).norm(), close) << k;
      ASSERT_LT((kernel.multipliers() - point.step.multipliers).norm(), close) << k;
      const Step<PlateBall> step{{PairArrow<double, 2>{std::get<0>(before.object), kernel.position()},
                                  attitude.transpose() * kernel.attitude()},
                                 kernel.multipliers()};
      ASSERT_LT(roundoff_ratio(system, before, step), 4) << k;
      ASSERT_LT((kernel.attitude() * kernel.body_momentum() - body).norm(), 1e-13) << k;
      const Vector2d q = kernel.position();
      const Vector2d p = kernel.linear_momentum();
      const auto spin = [](const Vector2d& at, const Vector2d& by) { return at(0) * by(1) - at(1) * by(0); };
      ASSERT_NEAR(spin(q, p) - kernel.body_momentum()(2), spin(position, linear) - body(2), 1e-13) << k;
      if (!rotating) {
        ASSERT_EQ(p, linear);
      }
    }
  }
}

TEST(PlateBallDerivatives, AreTheAutomaticOnes) {
  HandPlateBall hand;
  hand.h = 0.1;
  hand.radius = 1.3;
  hand.plate_rate = 0.7;
  hand.spin = 0.4;
  for (const Vector3d& x : {Vector3d(0.1, -0.2, 0.3), Vector3d(0.9, 0.4, -0.7), Vector3d(1e-3, 0, 2e-3)}) {
    const ArrowOf<PlateBall::GroupoidType> g{PairArrow<double, 2>{Vector2d(0.3, -0.2), Vector2d(0.4, 0.1)},
                                             SO3::exp(x)};
    const Vector3d lambda(0.5, -1.2, 0.8);
    const auto expected = automatic_two_sided<PlateBall>(hand, g, lambda);
    EXPECT_LT(largest(difference(hand.two_sided(g, lambda), expected)), 1e-13 * std::max(1.0, largest(expected)));
  }
}

template <class Kernel> class KeplerKernel : public ::testing::Test {};
using KeplerKernels = ::testing::Types<kernels::Kepler<0>, kernels::Kepler<1>, kernels::Kepler<2>, kernels::Kepler<4>>;
TYPED_TEST_SUITE(KeplerKernel, KeplerKernels);

TYPED_TEST(KeplerKernel, IsTheFramework) {
  Kepler system;
  system.h = 0.01;
  system.quadrature = Quadrature::midpoint;
  system.strength = 1.2;
  const State<Pair<2>> start{Vector2d(0.4, 0.1), Vector2d(-0.3, 2.0)};
  auto peer = framework(system, start, {start.object, start.object});
  TypeParam kernel(system.h, system.strength, start.object, start.momentum);
  for (int k = 0; k < steps; ++k) {
    const State<Pair<2>> before{kernel.position(), kernel.momentum()};
    ASSERT_TRUE(peer.advance().converged());
    kernel.step();
    ASSERT_LT((kernel.position() - peer.point().state.object).norm(), close) << k;
    ASSERT_LT((kernel.momentum() - peer.point().state.momentum).norm(), close) << k;
    ASSERT_LT(roundoff_ratio(system, before, Step<Kepler>{{before.object, kernel.position()}, {}}), 4) << k;
    ASSERT_NEAR(Kepler().symmetries()[0].momentum({kernel.position(), kernel.momentum()}),
                Kepler().symmetries()[0].momentum(start), 1e-13);
  }
}

TEST(SphericalPendulumKernel, IsTheFramework) {
  SphericalPendulum system;
  system.h = 0.02;
  system.bob_mass = 1.5;
  system.length = 1.25;
  system.gravity = 2;
  const State<Pair<3>> start{Vector3d(0.75, 0, -1), Vector3d(0.4, 0.9, 0.3)};
  auto peer = framework(system, start, {start.object, start.object});
  kernels::SphericalPendulum kernel(system.h, system.bob_mass, system.length, system.gravity, start.object,
                                    start.momentum);
  for (int k = 0; k < steps; ++k) {
    const State<Pair<3>> before{kernel.position(), kernel.momentum()};
    ASSERT_TRUE(peer.advance().converged());
    kernel.step();
    ASSERT_LT((kernel.position() - peer.point().state.object).norm(), close) << k;
    ASSERT_LT((kernel.momentum() - peer.point().state.momentum).norm(), close) << k;
    const Step<SphericalPendulum> step{{before.object, kernel.position()}, Vector<double, 1>(kernel.multiplier())};
    ASSERT_LT(roundoff_ratio(system, before, step), 4) << k;
    ASSERT_NEAR(SphericalPendulum().symmetries()[0].momentum({kernel.position(), kernel.momentum()}),
                SphericalPendulum().symmetries()[0].momentum(start), 1e-13);
  }
}

TEST(PlateBallBoundaryKernel, IsTheFramework) {
  for (const bool rotating : {false, true}) {
    const BoundaryCase c = boundary_case(rotating, 50);
    const auto expected = BoundaryNewton<PlateBall>().solve(c.problem, c.start, /*keep_multipliers=*/true);
    ASSERT_TRUE(expected.converged());
    kernels::PlateBallBoundary kernel(parameters(c.problem.system), nodes(c.start));
    const int iterations = kernel.solve(1e-12);
    ASSERT_GT(iterations, 0);
    ASSERT_LT(iterations, 10);
    EXPECT_NEAR(kernel.cost(), expected.cost, 1e-10 * expected.cost);
    const auto reference = nodes(expected.path);
    for (std::size_t k = 0; k < reference.multipliers.size(); ++k) {
      ASSERT_LT((kernel.positions()[k] - reference.position[k]).norm(), 1e-11);
      ASSERT_LT((kernel.attitudes()[k] - reference.attitude[k]).norm(), 1e-11);
      ASSERT_LT((kernel.multipliers(k) - reference.multipliers[k]).norm(), 1e-9);
    }
  }
}

TEST(RodriguesNewton, IsTheFramework) {
  for (const auto& z : bench::lie_newton_starts()) {
    Matrix3d y;
    const auto one = bench::lie_newton_on_so3(z, LieIteration::version1);
    ASSERT_TRUE(one.converged());
    EXPECT_EQ(kernels::RodriguesNewton::version1(z, bench::lie_newton_step, y), one.iterations);
    EXPECT_LT((y - one.y).norm(), close);
    const auto two = bench::lie_newton_on_so3(z, LieIteration::version2);
    ASSERT_TRUE(two.converged());
    EXPECT_EQ(kernels::RodriguesNewton::version2(z, bench::lie_newton_step, y), two.iterations);
    EXPECT_LT((y - two.y).norm(), close);
  }
}

TEST(PlateBallIpopt, ReachesTheSameMinimum) {
  for (const bool rotating : {false, true}) {
    const BoundaryCase c = boundary_case(rotating, 50);
    const auto expected = BoundaryNewton<PlateBall>().solve(c.problem, c.start, /*keep_multipliers=*/true);
    const auto found = kernels::solve_with_ipopt(parameters(c.problem.system), nodes(c.start), 1e-10);
    ASSERT_TRUE(expected.converged());
    ASSERT_TRUE(found.solved);
    EXPECT_NEAR(found.cost, expected.cost, 1e-8 * expected.cost);
    const auto reference = nodes(expected.path);
    for (std::size_t k = 0; k < reference.multipliers.size(); ++k) {
      ASSERT_LT((found.path.position[k] - reference.position[k]).norm(), 1e-8);
      ASSERT_LT((found.path.attitude[k] - reference.attitude[k]).norm(), 1e-8);
      ASSERT_LT((found.path.multipliers[k] - reference.multipliers[k]).norm(), 1e-6);
    }
  }
}

/// Heap allocations of a hundred calls.
template <class F> long allocations(const F& call) {
  const long before = allocation_count();
  for (int k = 0; k < 100; ++k) call();
  return allocation_count() - before;
}

TEST(Kernels, DoNotAllocate) {
  if (allocation_count() < 0) GTEST_SKIP() << "allocations cannot be counted here";
  kernels::So3Cayley<3> body(0.01, {1, 2, 3}, {0.4, 1.9, -1.1}, Matrix3d::Identity());
  kernels::PlateBall<3> ball({0.02, 1, 0.7, 0.4}, {{0.3, -0.2}, {0.9, 0.2}, {0.6, -0.4, 0.8}, Matrix3d::Identity()});
  kernels::PlateBallNewton<3> same_ball({0.02, 1, 0.7, 0.4},
                                        {{0.3, -0.2}, {0.9, 0.2}, {0.6, -0.4, 0.8}, Matrix3d::Identity()});
  kernels::Kepler<3> planet(0.01, 1, {0.8, 0}, {0, 1.2});
  kernels::SphericalPendulum pendulum(0.01, 1, 1, 1, {0.6, 0, -0.8}, {0.4, 0.9, 0.3});
  const BoundaryCase c = boundary_case(true, 20);
  kernels::PlateBallBoundary boundary(parameters(c.problem.system), nodes(c.start));
  EXPECT_EQ(allocations([&] { body.step(); }), 0);
  EXPECT_EQ(allocations([&] { ball.step(); }), 0);
  EXPECT_EQ(allocations([&] { same_ball.step(); }), 0);
  EXPECT_EQ(allocations([&] { planet.step(); }), 0);
  EXPECT_EQ(allocations([&] { pendulum.step(); }), 0);
  EXPECT_EQ(allocations([&] { boundary.iterate(); }), 0);
}

TEST(SphericalChainKernel, IsTheScene) {
  constexpr int links = 20;
  const auto scene = bench::hanging_chain(links, 1e-3);
  auto kernel = bench::chain_kernel(links, 1e-3);
  for (int k = 0; k < steps; ++k) {
    ASSERT_TRUE(scene->advance().converged());
    ASSERT_TRUE(kernel.step());
  }
  for (std::size_t i = 0; i < links; ++i)
    EXPECT_LT((scene->configuration().x[i] - kernel.places()[i].vector()).norm(), close) << i;
}

template <int K> void expect_pendulum_kernels_are_the_framework() {
  auto cf4 = bench::pendulum_cf4<K>();
  auto rattle = bench::pendulum_rattle<K>();
  const auto chain = bench::pendulum_chain<K>(K);
  const double h = bench::pendulum_step(K);
  LieGroupIntegrator by_exponentials(chain.space(), ChainMomentumField<K>(chain), lie_group_methods::commutator_free_4,
                                     chain.to_momenta(bench::pendulum_start<K>(K)), h);
  ChainRattle<K> variational(chain, bench::pendulum_start<K>(K), h);
  for (int k = 0; k < steps; ++k) {
    cf4.step();
    ASSERT_TRUE(rattle.step());
    ASSERT_TRUE(by_exponentials.advance().converged());
    ASSERT_TRUE(variational.advance().converged());
  }
  for (int i = 0; i < K; ++i) {
    const auto at = std::size_t(i);
    EXPECT_LT((cf4.directions()[at].vector() - by_exponentials.point().col(i).template head<3>()).norm(), close);
    EXPECT_LT((cf4.momenta()[at].vector() - by_exponentials.point().col(i).template tail<3>()).norm(), close);
    EXPECT_LT((rattle.directions()[at].vector() - variational.directions().col(i)).norm(), close);
    EXPECT_LT((rattle.velocities()[at].vector() - variational.velocities().col(i)).norm(), 10 * close);
  }
}

TEST(PendulumChainKernels, AreTheFramework) {
  expect_pendulum_kernels_are_the_framework<1>();
  expect_pendulum_kernels_are_the_framework<10>();
}

}  // namespace
