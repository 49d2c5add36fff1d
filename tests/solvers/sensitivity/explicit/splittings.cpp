// Derivatives of runs by compositions of flows.

#include "../differences.hpp"

#include <lagroid/solvers/sensitivity/explicit/linearised_splitting.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <random>

namespace lagroid::sensitivity_splittings_tests {
namespace {

constexpr long steps = 50;

RunFrom<Kepler> orbit(double by) {
  RunFrom<Kepler> out{Kepler(), {{0.6, 0.1 * by}, {0.1 * by, 1.5}}, {}, {"strength"}};
  out.system.h = 0.05;
  out.system.strength = 1 + 0.1 * by;
  out.configuration = Pair<2>::unit(out.start.object);
  return out;
}
RunFrom<RigidBody> body(double by) {
  RunFrom<RigidBody> out{RigidBody(), {{}, {0.3 + 0.1 * by, 1.5, 0.4}}, {}, {"inertia"}};
  out.system.h = 0.1;
  out.configuration = SO3::exp(Vector<double, 3>(0.2, by, 0.1));
  return out;
}

auto by(const Composition& composition) {
  return [&composition]<class Sys>(const RunFrom<Sys>& from) {
    return std::make_unique<LinearisedSplitting<Sys>>(from.system, from.start, from.configuration, composition,
                                                      from.names, EndOfRun());
  };
}

TEST(SplittingSensitivities, AreWhatDifferencesTendTo) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (int trial = 0; trial < 3; ++trial) {
    const double drawn = draw(random);
    expect_exact_derivatives(orbit(drawn), by(compositions::single), steps);
    expect_exact_derivatives(orbit(drawn), by(splittings::srkn6), steps);
    expect_exact_derivatives(body(drawn), by(compositions::suzuki), steps);
  }
}

TEST(SplittingSensitivities, AreSymplectic) {
  const auto motion = by(splittings::srkn6)(orbit(0.5));
  const Propagated end = propagate_forward(*motion, steps, Eigen::MatrixXd::Identity(5, 5));
  ASSERT_TRUE(end.converged());
  const Eigen::MatrixXd a = end.end.topLeftCorner(4, 4);
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(4, 4);
  form.topRightCorner(2, 2) = -Eigen::MatrixXd::Identity(2, 2);
  form.bottomLeftCorner(2, 2).setIdentity();
  EXPECT_LT((a.transpose() * form * a - form).norm(), 1e-12 * a.squaredNorm());
}

/// A spring whose force reads its stiffness as a plain number.
struct PlainForce : MechanicalSystem<PlainForce, 1> {
  double stiffness = 1;
  static auto parameters() { return std::tuple(parameter("stiffness", &PlainForce::stiffness, "N/m", "of a spring")); }
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 1>& q) const { return q(0) * q(0) * (varied<S>(stiffness) * 0.5); }
  template <class S> Vector<S, 1> gradient(const Vector<S, 1>& q) const { return q * S(stiffness); }
};
TEST(SplittingSensitivities, RefuseAParameterThatFlowsReadAsAPlainNumber) {
  const State<Pair<1>> start{Vector<double, 1>(1.0), Vector<double, 1>(0.5)};
  const RunFrom<PlainForce> from{PlainForce(), start, Pair<1>::unit(start.object), {"stiffness"}};
  const auto motion = by(compositions::suzuki)(from);
  ASSERT_TRUE(motion->advance().converged());
  EXPECT_THROW(motion->linearise(), WithoutDerivative);
}

}  // namespace
}  // namespace lagroid::sensitivity_splittings_tests
