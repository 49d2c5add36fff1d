// Derivatives of runs whose steps vary: adaptive ones, which keep the discrete energy, and prescribed ones.

#include "differences.hpp"
#include "held_sizes.hpp"

#include <lagroid/solvers/sensitivity/times/timed_sensitivities.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/driven_pendulum.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <vector>

namespace lagroid::sensitivity_timed_tests {
namespace {

using sensitivity_tests::end_of_sizes_held_fixed;

constexpr long steps = 40;

template <class Sys> struct Drawn {
  Sys system;
  State<typename Sys::GroupoidType> start;
  ArrowOf<typename Sys::GroupoidType> configuration;
  double* parameter(int which) {
    if constexpr (std::is_same_v<Sys, Kepler>) {
      return &system.strength;
    } else {
      return &system.inertia(which);
    }
  }
};
template <class Sys> std::vector<std::string> parameters_of() {
  if constexpr (std::is_same_v<Sys, Kepler>) {
    return {"strength"};
  } else {
    return {"inertia"};
  }
}

Drawn<Kepler> draw_kepler(unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> by(-0.05, 0.05);
  Drawn<Kepler> out;
  out.system.quadrature = Quadrature::midpoint;
  out.system.h = 0.05;
  out.system.strength = 1 + by(random);
  out.start.object = Vector<double, 2>(0.4 + by(random), by(random));
  out.start.momentum = Vector<double, 2>(by(random), 2 + by(random));
  out.configuration = out.system.groupoid.unit(out.start.object);
  return out;
}
Drawn<RigidBody> draw_body(unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> by(-0.2, 0.2);
  Drawn<RigidBody> out;
  out.system.h = 0.1;
  out.system.rotation = RotationMap::cayley;
  out.system.inertia = {1 + by(random), 2 + by(random), 3 + by(random)};
  out.start.momentum = {0.3 + by(random), 1.5 + by(random), 0.4 + by(random)};
  out.configuration = out.system.groupoid.unit(out.start.object);
  return out;
}

template <TimeMode mode, class Sys> TimedMotion<Sys, mode> motion_of(const Drawn<Sys>& from) {
  return TimedMotion<Sys, mode>(
      from.system, from.start, from.configuration, parameters_of<Sys>(), [](const auto& node) {
        const VariedVector arrow = node.system.groupoid.coordinates_of_arrow(node.configuration);
        VariedVector out(1 + arrow.size() + node.momentum.size());
        out << node.time, arrow, node.momentum;
        return out;
      });
}

/// (t, g, p) of the end, g the configuration; nothing where a step has no root, which is the only failure allowed.
template <TimeMode mode, class Sys> std::optional<Eigen::VectorXd> end_of(const Drawn<Sys>& from) {
  auto motion = motion_of<mode>(from);
  for (long k = 0; k < steps; ++k) {
    const StepReport report = motion.advance();
    if (report.converged()) continue;
    EXPECT_EQ(report.status, SolveStatus::no_step) << k;
    return std::nullopt;
  }
  const auto& point = motion.point();
  const Eigen::VectorXd arrow = from.system.groupoid.coordinates_of_arrow(point.configuration);
  Eigen::VectorXd out(1 + arrow.size() + point.state.momentum.size());
  out << point.time, arrow, point.state.momentum;
  return out;
}

/// By component `which` of (v, mu, parameters), extrapolated twice; nothing where a neighbour has no step.
template <TimeMode mode, class Sys> std::optional<Eigen::VectorXd> difference(const Drawn<Sys>& from, int which) {
  constexpr int n = Sys::dimension;
  const auto moved = [&](double by) {
    Drawn<Sys> to = from;
    if (which < n) {
      AlgebroidVector<typename Sys::GroupoidType> v;
      v.setZero();
      v(which) = by;
      to.configuration = to.system.groupoid.compose(from.configuration, to.system.groupoid.tau(from.start.object, v));
      to.start.object = to.system.groupoid.target(to.configuration);
    } else if (which < 2 * n) {
      to.start.momentum(which - n) += by;
    } else {
      *to.parameter(which - 2 * n) += by;
    }
    return end_of<mode>(to);
  };
  std::vector<Eigen::VectorXd> central;
  for (const double width : {1e-3, 5e-4, 2.5e-4}) {
    const auto above = moved(width);
    const auto below = moved(-width);
    if (!above || !below) return std::nullopt;
    central.emplace_back((*above - *below) / (2 * width));
  }
  const Eigen::VectorXd coarse = (4 * central[1] - central[0]) / 3;
  const Eigen::VectorXd fine = (4 * central[2] - central[1]) / 3;
  return (16 * fine - coarse) / 15;
}

/// Of some draws no step has a root, or of a neighbour that a difference needs: those are counted.
template <TimeMode mode, class Sys, class Draw> void compare_with_differences(const Draw& draw, int draws) {
  int compared = 0;
  int asked = 0;
  for (unsigned seed = 1; seed <= unsigned(draws); ++seed) {
    const Drawn<Sys> from = draw(seed);
    auto motion = motion_of<mode>(from);
    const int count = motion.states() + motion.parameters();
    const Propagated end = propagate_forward(motion, steps, Eigen::MatrixXd::Identity(count, count));
    EXPECT_EQ(end.converged(), end_of<mode>(from).has_value()) << seed << ": " << end.message;
    const int of_start = 2 * Sys::dimension;
    asked += of_start + motion.parameters();
    if (!end.converged()) continue;
    auto backwards = motion_of<mode>(from);
    const Propagated back = propagate_backward(backwards, steps, Observed::at_end(), {5});
    ASSERT_TRUE(back.converged()) << back.message;
    EXPECT_LE(back.states_kept, 5);
    EXPECT_LT((back.derivatives - end.derivatives).norm(), 2e-12 * end.derivatives.norm()) << seed;
    for (int which = 0; which < of_start + motion.parameters(); ++which) {
      const auto differences = difference<mode>(from, which);
      if (!differences) continue;
      ++compared;
      const int column = which < of_start ? which : which - of_start + motion.states();
      EXPECT_LT((end.derivatives.col(column) - *differences).norm(), 1e-8 * std::max(1.0, differences->norm()))
          << seed << ", " << which;
    }
  }
  EXPECT_GE(3 * compared, 2 * asked);
  ::testing::Test::RecordProperty("compared", compared);
}

TEST(TimedSensitivities, OfAdaptiveStepsAreWhatDifferencesTendTo) {
  compare_with_differences<TimeMode::adaptive, Kepler>(draw_kepler, 12);
}
TEST(TimedSensitivities, OfAdaptiveStepsOnAGroupoidWithABracketToo) {
  compare_with_differences<TimeMode::adaptive, RigidBody>(draw_body, 6);
}
TEST(TimedSensitivities, OfPrescribedStepsAreWhatDifferencesTendTo) {
  compare_with_differences<TimeMode::prescribed, Kepler>(draw_kepler, 6);
}

/// Steps of the same sizes that do not depend on the start: their derivatives are others.
TEST(TimedSensitivities, OfSizesHeldFixedMissTheDifferences) {
  const Drawn<Kepler> from = draw_kepler(1);
  auto motion = motion_of<TimeMode::adaptive>(from);
  const Eigen::MatrixXd held = end_of_sizes_held_fixed(motion, from.system, steps);
  const auto differences = difference<TimeMode::adaptive>(from, 0);
  ASSERT_TRUE(differences);
  EXPECT_GT((held.col(0) - differences->tail(4)).norm(), 1e-2 * differences->norm());
}

/// d(mu) ^ d(q) + d(p_t) ^ d(t) of states (q, p, t, p_t) on pairs.
Eigen::MatrixXd form(bool extended) {
  const int n = 2;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(extended ? 6 : 4, extended ? 6 : 4);
  out.block(0, n, n, n) = -Eigen::MatrixXd::Identity(n, n);
  out.block(n, 0, n, n).setIdentity();
  if (extended) {
    out(4, 5) = -1;
    out(5, 4) = 1;
  }
  return out;
}
template <TimeMode mode> void expect_symplectic_steps() {
  const Drawn<Kepler> from = draw_kepler(4);
  auto motion = motion_of<mode>(from);
  for (long k = 0; k < steps; ++k) {
    ASSERT_TRUE(motion.advance().converged());
    ASSERT_TRUE(motion.linearise());
    if (k == 0) continue;  // of a given size
    const int count = motion.states() + motion.parameters();
    const Eigen::MatrixXd matrix = motion.stage(0).forward(Eigen::MatrixXd::Identity(count, count)).topLeftCorner(6, 6);
    EXPECT_LT((matrix.transpose() * form(true) * matrix - form(true)).norm(), 1e-12 * matrix.squaredNorm()) << k;
  }
}
TEST(TimedSensitivities, AreSymplecticOnTheExtendedPhaseSpace) {
  expect_symplectic_steps<TimeMode::adaptive>();
  expect_symplectic_steps<TimeMode::prescribed>();
  const Drawn<Kepler> from = draw_kepler(4);
  const Sensitivities end = sensitivities<TimeMode::adaptive>(from.system, from.start, {.steps = steps});
  ASSERT_TRUE(end.converged()) << end.message;
  const Eigen::MatrixXd& a = end.by_start;
  EXPECT_LT((a.transpose() * form(true) * a - form(false)).norm(), 1e-12 * a.squaredNorm());
  const Eigen::MatrixXd places = a.topRows(4);
  EXPECT_GT((places.transpose() * form(false) * places - form(false)).norm(), 1e-3)
      << "at the same step it is not at one time";
}

template <class Sys> RunFrom<Sys> swinging(double angle, double momentum, double h, std::vector<std::string> names) {
  RunFrom<Sys> out{Sys(), {Vector<double, 1>(angle), Vector<double, 1>(momentum)}, {}, std::move(names)};
  out.system.h = h;
  out.configuration = Pair<1>::unit(out.start.object);
  return out;
}
auto going_on = []<class Sys>(const RunFrom<Sys>& from) {
  return std::make_unique<LinearisedTimedMotion<Sys, TimeMode::adaptive>>(
      from.system, from.start, from.configuration, from.names, EndAndTime(), WithoutRoot::constant);
};
/// By steps of the first one's size, which are the same steps of all runs that a difference is of.
TEST(TimedSensitivities, GoOnWhereTheEnergyHasNoRoot) {
  const RunFrom<Pendulum> from = swinging<Pendulum>(0, 2.5, 0.05, {"mass", "length"});
  for (const long count : {20L, 40L}) {
    const auto motion = going_on(from);
    for (long k = 0; k < count; ++k) ASSERT_TRUE(motion->advance().converged());
    EXPECT_GT(motion->without_root(), 5);
    EXPECT_LT(motion->without_root(), count - 5);
    expect_exact_derivatives(from, going_on, count);
  }
  RunFrom<DrivenPendulum> driven = swinging<DrivenPendulum>(0, 2.5, 0.05, {"mass", "torque", "frequency"});
  driven.system.torque = 0.05;
  driven.system.frequency = 0.7;
  const auto motion = going_on(driven);
  for (long k = 0; k < 20; ++k) ASSERT_TRUE(motion->advance().converged());
  EXPECT_GT(motion->without_root(), 0);
  expect_exact_derivatives(driven, going_on, 20);
  EXPECT_THROW((LinearisedTimedMotion<Pendulum, TimeMode::adaptive>(from.system, from.start, from.configuration, {},
                                                                    EndAndTime(), WithoutRoot::controlled)),
               std::invalid_argument);
}

TEST(TimedSensitivities, SayWhereThereIsNoStep) {
  Drawn<Kepler> from = draw_kepler(1);
  from.system.quadrature = Quadrature::trapezoid;
  const Sensitivities end = sensitivities<TimeMode::adaptive>(from.system, from.start, {.steps = 200});
  EXPECT_EQ(end.status, SolveStatus::no_step);
  EXPECT_NE(end.message.find("has no root: no size near that of the last step solves its equations"), std::string::npos)
      << end.message;
  EXPECT_EQ(end.by_start.size(), 0);
}

TEST(TimedSensitivities, RefuseWhatHasNone) {
  const Drawn<Kepler> from = draw_kepler(1);
  const auto time = [](const auto& node) { return node.time; };
  EXPECT_THROW(
      gradient<TimeMode::adaptive>(from.system, from.start, time, {.steps = 5, .observed = Observed::integral()}),
      std::invalid_argument);
  EXPECT_THROW(sensitivities<TimeMode::prescribed>(from.system, from.start, {.steps = 5, .parameters = {"weight"}}),
               std::invalid_argument);
  const RunGradient end = gradient<TimeMode::prescribed>(from.system, from.start, time, {.steps = 5});
  ASSERT_TRUE(end.converged());
  EXPECT_EQ(end.by_start.cols(), 4);
  EXPECT_NE(end.by_start.norm(), 0);
}

}  // namespace
}  // namespace lagroid::sensitivity_timed_tests
