// Derivatives of runs of the rigid body by Moser and Veselov's steps, whose moments are made for the start.

#include "../differences.hpp"

#include <lagroid/systems/rotations/linearised_moser_veselov.hpp>

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <random>

namespace lagroid::sensitivity_moser_veselov_tests {
namespace {

constexpr long steps = 50;
constexpr std::array orders{2, 4, 6, 8, 10};

RunFrom<RigidBody> body(const Vector<double, 3>& inertia, const Vector<double, 3>& momentum) {
  RunFrom<RigidBody> out{RigidBody(), {{}, momentum}, {}, {"inertia"}};
  out.system.h = 0.1;
  out.system.inertia = inertia;
  out.configuration = SO3::exp(Vector<double, 3>(0.2, 0.4, 0.1));
  return out;
}

auto of_order(int order) {
  return [order](const RunFrom<RigidBody>& from) {
    return std::make_unique<LinearisedMoserVeselov>(from.system, from.start, from.configuration, order, from.names,
                                                    EndOfRun());
  };
}

TEST(MoserVeselovSensitivities, AreWhatDifferencesTendTo) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> draw(-0.2, 0.2);
  const auto vector = [&](double x, double y, double z) {
    return Vector<double, 3>(x + draw(random), y + draw(random), z + draw(random));
  };
  for (const int order : orders)
    expect_exact_derivatives(body(vector(2.5, 1, 2), vector(0.3, 1.5, 0.4)), of_order(order), steps);
}

/// Where two moments are equal they change places on both sides of a difference.
TEST(MoserVeselovSensitivities, OfSymmetricBodiesToo) {
  for (const Vector<double, 3>& inertia : {Vector<double, 3>(1, 1, 1.5), Vector<double, 3>(2, 1, 2)}) {
    expect_exact_derivatives(body(inertia, {0.3, 1.5, 0.4}), of_order(10), steps);
    expect_exact_derivatives(body(inertia, {0, 1.5, 0}), of_order(6), steps);
  }
}

enum class Moments { made_of_the_start, held };
/// Of (displacement, momentum) at the end, by those at the start, and the momentum at the end.
struct Transition {
  Eigen::MatrixXd matrix;
  Vector<double, 3> momentum;
};
Transition transition(const RunFrom<RigidBody>& from, int order, long count, Moments moments) {
  const auto motion = of_order(order)(from);
  Eigen::MatrixXd out = directions_of_start(*motion, 6).leftCols(6);
  for (long k = 0; k < count; ++k) {
    EXPECT_TRUE(motion->advance().converged() && motion->linearise());
    for (int stage = 0; stage < motion->stages(); ++stage)
      if (stage + 1 == motion->stages() || moments == Moments::made_of_the_start)
        out = motion->stage(stage).forward(out);
  }
  return {out.topRows(6), motion->observe().values.tail(3)};
}
const RunFrom<RigidBody> tumbling = body({2.5, 1, 2}, {0.3, 1.5, 0.4});

TEST(MoserVeselovSensitivities, OfHeldMomentsMissTheDifferences) {
  const auto motion = of_order(10)(tumbling);
  const Propagated end = propagate_forward(*motion, steps, directions_of_start(*motion, 6));
  const auto missed = [&](Moments moments) {
    const Eigen::MatrixXd all = end.end.topLeftCorner(6, 6);
    return (transition(tumbling, 10, steps, moments).matrix - all).norm() / all.norm();
  };
  EXPECT_LT(missed(Moments::made_of_the_start), 1e-14);
  EXPECT_GT(missed(Moments::held), 1e-4);
}

TEST(MoserVeselovSensitivities, OfHeldMomentsAreSymplectic) {
  const auto form = [](const Vector<double, 3>& momentum) {
    return laws::detail::symplectic_form(tumbling.system.groupoid, State<SO3>{{}, momentum});
  };
  const auto defect = [&](int order, Moments moments) {
    const auto [a, momentum] = transition(tumbling, order, steps, moments);
    return (a.transpose() * form(momentum) * a - form(tumbling.start.momentum)).norm() / a.squaredNorm();
  };
  for (const int order : orders) EXPECT_LT(defect(order, Moments::held), 1e-13) << order;
  EXPECT_GT(defect(4, Moments::made_of_the_start), 1e-9);
}

TEST(MoserVeselovSensitivities, AreOfTheOrderOfTheMethod) {
  const Eigen::MatrixXd limit = transition(tumbling, 10, 20, Moments::made_of_the_start).matrix;
  const auto measured = [&](int order, Moments moments) {
    const auto off = [&](long count) {
      RunFrom<RigidBody> from = tumbling;
      from.system.h = 2.0 / double(count);
      return (transition(from, order, count, moments).matrix - limit).norm();
    };
    return std::log2(off(8) / off(16));
  };
  for (const int order : {2, 4, 6}) EXPECT_NEAR(measured(order, Moments::made_of_the_start), order, 0.15) << order;
  EXPECT_NEAR(measured(6, Moments::held), 2, 0.15) << "the method for another trajectory";
}

TEST(MoserVeselovSensitivities, RefuseTheInertiaOfASphere) {
  RunFrom<RigidBody> from = body({1, 1, 1 + 1e-6}, {0.3, 1.5, 0.4});
  EXPECT_THROW(of_order(4)(from), WithoutDerivative);
  expect_exact_derivatives(from, of_order(2), steps);
  from.names.clear();
  expect_exact_derivatives(from, of_order(10), steps);
  from.names = {"colour"};
  EXPECT_THROW(of_order(2)(from), std::invalid_argument);
}

}  // namespace
}  // namespace lagroid::sensitivity_moser_veselov_tests
