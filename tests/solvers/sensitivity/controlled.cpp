// Derivatives of runs by controlled steps, and of what is seen between the nodes of runs whose steps vary.

#include "held_sizes.hpp"

#include <lagroid/solvers/sensitivity/times/timed_sensitivities.hpp>
#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <tuple>
#include <vector>

namespace lagroid::sensitivity_controlled_tests {
namespace {

using sensitivity_tests::end_of_sizes_held_fixed;

constexpr long steps = 60;

template <class Sys> struct Case {
  Sys system;
  State<typename Sys::GroupoidType> start;
  std::vector<std::string> names;
};

template <class Sys, TimeMode mode> TimedMotion<Sys, mode> motion_of(const Case<Sys>& from) {
  return TimedMotion<Sys, mode>(from.system, from.start, from.system.groupoid.unit(from.start.object), from.names,
                                [](const auto& node) {
                                  const VariedVector object = node.system.groupoid.coordinates_of_object(node.object);
                                  VariedVector out(1 + object.size() + node.momentum.size());
                                  out << node.time, object, node.momentum;
                                  return out;
                                });
}

/// A start that differs: by a displacement or momentum, or a parameter.
template <class Sys> Case<Sys> moved(Case<Sys> from, int which, double by) {
  constexpr int n = Sys::dimension;
  if (which < n) {
    AlgebroidVector<typename Sys::GroupoidType> v = AlgebroidVector<typename Sys::GroupoidType>::Zero();
    v(which) = by;
    from.start.object = from.system.groupoid.target(from.system.groupoid.tau(from.start.object, v));
  } else if (which < 2 * n) {
    from.start.momentum(which - n) += by;
  } else {
    const ParameterPlaces places = places_of_parameters(from.system, from.names);
    const_cast<double&>(*places.members[std::size_t(which - 2 * n)]) += by;
  }
  return from;
}

/// Central differences of `value`, extrapolated twice.
template <class Sys>
Eigen::VectorXd difference(const Case<Sys>& from, int which,
                           const std::function<Eigen::VectorXd(const Case<Sys>&)>& value) {
  return laws::detail::extrapolated_difference([&](double by) { return value(moved(from, which, by)); }, 1e-3);
}

template <class Sys> void expect_differences(const Case<Sys>& from) {
  constexpr TimeMode mode = TimeMode::controlled;
  auto motion = motion_of<Sys, mode>(from);
  const int count = motion.states() + motion.parameters();
  const Propagated end = propagate_forward(motion, steps, Eigen::MatrixXd::Identity(count, count));
  ASSERT_TRUE(end.converged()) << end.message;
  auto again = motion_of<Sys, mode>(from);
  const Propagated back = propagate_backward(again, steps, Observed::at_end(), {5});
  ASSERT_TRUE(back.converged()) << back.message;
  EXPECT_LT((back.derivatives - end.derivatives).norm(), 2e-12 * end.derivatives.norm());
  const auto value = [](const Case<Sys>& at) -> Eigen::VectorXd {
    auto run = motion_of<Sys, mode>(at);
    for (long k = 0; k < steps; ++k) EXPECT_TRUE(run.advance().converged());
    return run.observe().values;
  };
  for (int which = 0; which < 2 * Sys::dimension + motion.parameters(); ++which) {
    const Eigen::VectorXd differences = difference<Sys>(from, which, value);
    const int column = which < 2 * Sys::dimension ? which : which - 2 * Sys::dimension + motion.states();
    EXPECT_LT((end.derivatives.col(column) - differences).norm(), 1e-8 * std::max(1.0, differences.norm())) << which;
  }
}

Case<Kepler> ellipse() {
  Case<Kepler> out{{}, {{0.4, 0.05}, {-0.1, 2}}, {"strength"}};
  out.system.h = 0.05;
  return out;
}

TEST(ControlledSensitivities, AreWhatDifferencesTendTo) {
  expect_differences(ellipse());
  Case<Pendulum> pendulum{{}, {Vector<double, 1>(1.2), Vector<double, 1>(0.3)}, {"length", "gravity", "mass"}};
  pendulum.system.h = 0.1;
  expect_differences(pendulum);
}
TEST(ControlledSensitivities, OnGroupoidsWithABracketToo) {
  Case<RigidBody> body{{}, {{}, {0.3, 1.5, 0.4}}, {"inertia"}};
  body.system.inertia = {1, 2, 3};
  body.system.h = 0.1;
  expect_differences(body);
  Case<HeavyTop> top{{}, {{0, 0.6, 0.8}, {0.3, -0.2, 1.5}}, {"inertia", "weight"}};
  top.system.inertia = {1, 1.4, 0.6};
  top.system.weight = {0.2, 0.1, 1};
  top.system.h = 0.05;
  expect_differences(top);
  top.system.inertia = {1, 1, 0.6};  // the largest twice: time goes by no corner there
  expect_differences(top);
}
TEST(ControlledSensitivities, OfOptimalControlToo) {
  Case<PlateBall> ball{{}, {}, {"radius", "plate_rate", "spin"}};
  ball.system.h = 0.05;
  ball.system.plate_rate = 0.4;
  ball.system.spin = 0.3;
  std::get<0>(ball.start.object) = {0.2, 0.1};
  ball.start.momentum << 0.3, -0.2, 0.5, 0.4, 0.2;
  expect_differences(ball);
}
TEST(ControlledSensitivities, WithConstraintsOfPlacesToo) {
  Case<SphericalPendulum> pendulum{{}, {}, {"mass", "gravity"}};
  pendulum.system.length = 1;
  pendulum.start = {{0.6, 0, -0.8}, {0.4, 0.9, 0.3}};
  pendulum.system.h = 0.05;
  auto motion = motion_of<SphericalPendulum, TimeMode::controlled>(pendulum);
  Eigen::MatrixXd along_gravity = Eigen::MatrixXd::Zero(motion.states() + motion.parameters(), 1);
  along_gravity(motion.states() + 1) = 1;
  const Propagated end = propagate_forward(motion, steps, along_gravity);
  ASSERT_TRUE(end.converged()) << end.message;
  const auto value = [](const Case<SphericalPendulum>& at) -> Eigen::VectorXd {
    auto run = motion_of<SphericalPendulum, TimeMode::controlled>(at);
    for (long k = 0; k < steps; ++k) EXPECT_TRUE(run.advance().converged());
    return run.observe().values;
  };
  const Eigen::VectorXd by_gravity = difference<SphericalPendulum>(pendulum, 7, value);
  EXPECT_LT((end.derivatives.col(0) - by_gravity).norm(), 1e-8 * by_gravity.norm());
}

/// A controller that the derivative takes for a constant: the same steps, another end.
TEST(ControlledSensitivities, OfSizesHeldFixedMissTheDifferences) {
  const Case<Kepler> from = ellipse();
  auto motion = motion_of<Kepler, TimeMode::controlled>(from);
  const Eigen::MatrixXd held = end_of_sizes_held_fixed(motion, from.system, steps);
  const Eigen::VectorXd differences = difference<Kepler>(from, 0, [](const Case<Kepler>& at) -> Eigen::VectorXd {
    auto run = motion_of<Kepler, TimeMode::controlled>(at);
    for (long k = 0; k < steps; ++k) EXPECT_TRUE(run.advance().converged());
    return run.observe().values;
  });
  EXPECT_GT((held.col(0) - differences.tail(4)).norm(), 1e-2 * differences.norm());
}

TEST(ControlledSensitivities, SayWhereThereIsNoStep) {
  Case<Kepler> from = ellipse();
  from.system.h = 3;  // the motion changes too fast for it
  from.start.momentum = {3, 0.1};
  const Sensitivities end = sensitivities<TimeMode::controlled>(from.system, from.start, {.steps = steps});
  EXPECT_EQ(end.status, SolveStatus::no_step);
  EXPECT_EQ(end.by_start.size(), 0);
}

/// At a time that is fixed, whatever the nodes are before it.
template <TimeMode mode> void expect_differences_between_nodes(const Case<Kepler>& from, double time) {
  const auto walk = [&](TimedMotion<Kepler, mode>& motion, Eigen::MatrixXd& directions) {
    for (std::vector<double> before = motion.save();; before = motion.save()) {
      ASSERT_TRUE(motion.advance().converged());
      if (motion.time() > time) return motion.restore(before);
      ASSERT_TRUE(motion.linearise());
      directions = motion.stage(0).forward(directions);
    }
  };
  auto motion = motion_of<Kepler, mode>(from);
  Eigen::MatrixXd directions =
      Eigen::MatrixXd::Identity(motion.states() + motion.parameters(), motion.states() + motion.parameters());
  walk(motion, directions);
  const auto here = motion.observe_later(time);
  ASSERT_TRUE(here);
  EXPECT_EQ(here->values(0), time);
  const Eigen::MatrixXd by = here->derivatives * directions;
  const auto value = [&](const Case<Kepler>& at) -> Eigen::VectorXd {
    auto run = motion_of<Kepler, mode>(at);
    Eigen::MatrixXd none = Eigen::MatrixXd::Zero(run.states() + run.parameters(), 0);
    walk(run, none);
    return run.observe_later(time)->values;
  };
  for (int which = 0; which < 5; ++which) {
    const Eigen::VectorXd differences = difference<Kepler>(from, which, value);
    const int column = which < 4 ? which : motion.states();
    EXPECT_LT((by.col(column) - differences).norm(), 1e-8 * differences.norm()) << which;
    EXPECT_LT(std::abs(by(0, column)), 1e-12) << "the time is given";
  }
}
TEST(ControlledSensitivities, BetweenNodesAreWhatDifferencesTendTo) {
  expect_differences_between_nodes<TimeMode::controlled>(ellipse(), 1.013);
  expect_differences_between_nodes<TimeMode::prescribed>(ellipse(), 1.013);
  Case<Kepler> free = ellipse();
  free.system.quadrature = Quadrature::midpoint;
  expect_differences_between_nodes<TimeMode::adaptive>(free, 0.513);
}

}  // namespace
}  // namespace lagroid::sensitivity_controlled_tests
