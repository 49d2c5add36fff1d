// Derivatives of runs by compositions of flows.

#include <lagroid/solvers/sensitivity/explicit/linearised_splitting.hpp>
#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace lagroid::sensitivity_splittings_tests {
namespace {

constexpr long steps = 50;

template <class Sys> struct Drawn {
  Sys system;
  State<typename Sys::GroupoidType> start;
  ArrowOf<typename Sys::GroupoidType> configuration;
  Composition composition;
  std::vector<std::string> names;
};
Drawn<Kepler> orbit(double by, const Composition& composition) {
  Drawn<Kepler> out{Kepler(), {{0.6, 0.1 * by}, {0.1 * by, 1.5}}, {}, composition, {"strength"}};
  out.system.h = 0.05;
  out.system.strength = 1 + 0.1 * by;
  out.configuration = Pair<2>::unit(out.start.object);
  return out;
}
Drawn<RigidBody> body(double by) {
  Drawn<RigidBody> out{RigidBody(), {{}, {0.3 + 0.1 * by, 1.5, 0.4}}, {}, compositions::suzuki, {}};
  out.system.h = 0.1;
  out.configuration = SO3::exp(Vector<double, 3>(0.2, by, 0.1));
  return out;
}

template <class Sys> LinearisedSplitting<Sys> motion_of(const Drawn<Sys>& from) {
  return LinearisedSplitting<Sys>(
      from.system, from.start, from.configuration, from.composition, from.names, [](const auto& node) {
        const VariedVector arrow = node.system.groupoid.coordinates_of_arrow(node.configuration);
        VariedVector out(arrow.size() + node.momentum.size());
        out << arrow, node.momentum;
        return out;
      });
}

template <class Sys> void expect_differences(const Drawn<Sys>& from) {
  constexpr int n = Sys::dimension;
  auto motion = motion_of(from);
  const int count = motion.states() + motion.parameters();
  const Propagated forward = propagate_forward(motion, steps, Eigen::MatrixXd::Identity(count, count));
  ASSERT_TRUE(forward.converged()) << forward.message;
  auto again = motion_of(from);
  const Propagated backward = propagate_backward(again, steps, Observed::at_end(), {5});
  EXPECT_LT((backward.derivatives - forward.derivatives).norm(), 1e-12 * forward.derivatives.norm());
  for (int which = 0; which < count; ++which) {
    const auto end = [&](double by) -> Eigen::VectorXd {
      Drawn<Sys> to = from;
      const auto& groupoid = to.system.groupoid;
      if (which < n) {
        AlgebroidVector<typename Sys::GroupoidType> v;
        v.setZero();
        v(which) = by;
        to.configuration = groupoid.compose(from.configuration, groupoid.tau(from.start.object, v));
        to.start.object = groupoid.target(to.configuration);
      } else if (which < 2 * n) {
        to.start.momentum(which - n) += by;
      } else {
        const ParameterPlaces places = places_of_parameters(to.system, to.names);
        const_cast<double&>(*places.members[std::size_t(which - 2 * n)]) += by;
      }
      auto moved = motion_of(to);
      return propagate_forward(moved, steps, Eigen::MatrixXd::Zero(count, 0)).values;
    };
    const Eigen::VectorXd difference = laws::detail::extrapolated_difference(end, 2e-3);
    EXPECT_LT((forward.derivatives.col(which) - difference).norm(), 1e-8 * std::max(1.0, difference.norm())) << which;
  }
}

TEST(SplittingSensitivities, AreWhatDifferencesTendTo) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (int trial = 0; trial < 3; ++trial) {
    const double by = draw(random);
    expect_differences(orbit(by, compositions::single));
    expect_differences(orbit(by, splittings::srkn6));
    expect_differences(body(by));
  }
}

TEST(SplittingSensitivities, AreSymplectic) {
  auto motion = motion_of(orbit(0.5, splittings::srkn6));
  const Propagated end = propagate_forward(motion, steps, Eigen::MatrixXd::Identity(5, 5));
  ASSERT_TRUE(end.converged());
  const Eigen::MatrixXd a = end.end.topLeftCorner(4, 4);
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(4, 4);
  form.topRightCorner(2, 2) = -Eigen::MatrixXd::Identity(2, 2);
  form.bottomLeftCorner(2, 2).setIdentity();
  EXPECT_LT((a.transpose() * form * a - form).norm(), 1e-12 * a.squaredNorm());
}

/// The flows of the body's kinetic energy read its inertia as plain numbers.
TEST(SplittingSensitivities, RefuseAParameterThatFlowsReadAsAPlainNumber) {
  Drawn<RigidBody> from = body(0);
  from.names = {"inertia"};
  auto motion = motion_of(from);
  ASSERT_TRUE(motion.advance().converged());
  EXPECT_THROW(motion.linearise(), WithoutDerivative);
}

}  // namespace
}  // namespace lagroid::sensitivity_splittings_tests
