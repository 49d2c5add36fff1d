// Derivatives through events: those of falls that are known in closed form, and what differences of runs tend to.
#include <lagroid/core/parameter.hpp>
#include <lagroid/run/events/derivatives/event_sensitivities.hpp>
#include <lagroid/solvers/integrators/composition.hpp>
#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/systems/mechanical.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/pendulums/driven_pendulum.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace lagroid;

namespace events_sensitivities_tests {
namespace {

/// A ball that falls: nodes of parabolas are exact.
struct Ball : MechanicalSystem<Ball, 1> {
  double gravity = 2;
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 1>& q) const { return q(0) * varied<S>(gravity); }
  static auto parameters() {
    return std::tuple(parameter("gravity", &Ball::gravity, "m/s^2", "acceleration", positive));
  }
};

/// A bob on a spring, in the plane.
struct Bob : MechanicalSystem<Bob, 2> {
  double stiffness = 3;
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 2>& q) const {
    using std::sqrt;
    const S stretch = sqrt(q.squaredNorm()) - 0.7;
    return stretch * stretch * (varied<S>(stiffness) * 0.5) + q(1);
  }
  static auto parameters() {
    return std::tuple(parameter("stiffness", &Bob::stiffness, "N/m", "of the spring", positive));
  }
};

using Events = std::vector<SmoothEvent<Ball>>;

SmoothEvent<Ball> floor_of_ball() {
  SmoothEvent<Ball> floor{"floor", [](const EventNode<Ball>& node) { return node.object(0); }};
  floor.direction = Event::Direction::falling;
  return floor;
}

/// Sends it back with the share `e` of its speed.
SmoothEvent<Ball> bouncing(double e) {
  SmoothEvent<Ball> floor = floor_of_ball();
  floor.kick = [e](const EventNode<Ball>& node) { return VariedVector(node.momentum * VariedNumber(-(1 + e))); };
  return floor;
}

const State<Pair<1>> thrown{Vector<double, 1>(1.0), Vector<double, 1>(0.3)};

TEST(EventSensitivities, OfAFallAreThoseOfItsFormula) {
  Ball ball;
  ball.h = 0.11;
  SmoothEvent<Ball> floor = floor_of_ball();
  floor.then = Event::Then::stop;
  const EventSensitivities fall =
      event_sensitivities(ball, thrown, Events{floor}, {.steps = 100, .parameters = {"gravity"}});
  ASSERT_TRUE(fall.converged()) << fall.message;
  ASSERT_EQ(fall.happened.size(), 1u);
  const double q = 1, v = 0.3, g = 2, root = std::sqrt(v * v + 2 * g * q), t = (v + root) / g;
  EXPECT_NEAR(fall.happened[0].time, t, 1e-13);
  EXPECT_NEAR(fall.happened[0].by_start(0), 1 / root, 1e-12);
  EXPECT_NEAR(fall.happened[0].by_start(1), (1 + v / root) / g, 1e-12);
  EXPECT_NEAR(fall.happened[0].by_parameters(0), q / root / g - t / g, 1e-12);
  // It is on the floor whatever the start, with the speed that the energy gives.
  EXPECT_NEAR(fall.by_start.row(0).norm() + fall.by_parameters.row(0).norm(), 0, 1e-12);
  EXPECT_NEAR(fall.by_start(1, 0), -g / root, 1e-12);
  EXPECT_NEAR(fall.by_start(1, 1), -v / root, 1e-12);
  EXPECT_NEAR(fall.by_parameters(1, 0), -q / root, 1e-12);
}

TEST(EventSensitivities, ThroughBouncesAreThoseOfTheFormula) {
  Ball ball;
  ball.h = 0.11;
  const double e = 0.8;
  const EventSensitivities end =
      event_sensitivities(ball, thrown, Events{bouncing(e)}, {.steps = 19, .parameters = {"gravity"}});
  ASSERT_TRUE(end.converged()) << end.message;
  ASSERT_EQ(end.happened.size(), 1u);
  const double q = 1, v = 0.3, g = 2, root = std::sqrt(v * v + 2 * g * q), t = (v + root) / g, rest = 19 * 0.11 - t;
  // q(T) = e root (T - t) - g (T - t)^2 / 2, momentum e root - g (T - t).
  const Eigen::RowVector3d by_root(g / root, v / root, q / root);
  const Eigen::RowVector3d by_t(1 / root, (1 + v / root) / g, q / root / g - t / g);
  Eigen::RowVector3d place = e * rest * by_root - (e * root - g * rest) * by_t;
  Eigen::RowVector3d momentum = e * by_root + g * by_t;
  place(2) -= rest * rest / 2;
  momentum(2) -= rest;
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(end.by_start(0, i), place(i), 1e-11) << i;
    EXPECT_NEAR(end.by_start(1, i), momentum(i), 1e-11) << i;
  }
  EXPECT_NEAR(end.by_parameters(0, 0), place(2), 1e-11);
  EXPECT_NEAR(end.by_parameters(1, 0), momentum(2), 1e-11);
}

TEST(EventSensitivities, ObserveWhereEventsHappenAndAtANode) {
  Ball ball;
  ball.h = 0.11;
  const double g = 2, q = 1, v = 0.3, root = std::sqrt(v * v + 2 * g * q);
  const auto observe = [](const EventNode<Ball>& node) {
    VariedVector both(2);
    both << node.object(0), node.momentum(0) * node.time;
    return both;
  };
  SensitivityOptions<Ball> options{.steps = 12, .parameters = {"gravity"}};
  options.observed = Observed::at_node(4);
  const EventSensitivities run = event_sensitivities<Ball>(ball, thrown, Events{bouncing(0.8)}, options, observe);
  ASSERT_TRUE(run.converged()) << run.message;
  ASSERT_EQ(run.happened.size(), 1u);
  const double t = (v + root) / g;
  // Before the kick: on the floor, with the speed of the fall.
  EXPECT_NEAR(run.happened[0].observed(0), 0, 1e-13);
  EXPECT_NEAR(run.happened[0].observed(1), -root * t, 1e-12);
  EXPECT_NEAR(run.happened[0].observed_by_start.row(0).norm(), 0, 1e-12);
  EXPECT_NEAR(run.happened[0].observed_by_start(1, 1), -v / root * t - root * (1 + v / root) / g, 1e-11);
  EXPECT_NEAR(run.happened[0].observed_by_parameters(1, 0), -q / root * t - root * (q / root / g - t / g), 1e-11);
  // Node four is on the way up and down: q + v t - g t^2 / 2.
  const double s = 0.44;
  EXPECT_NEAR(run.observed(0), q + v * s - g * s * s / 2, 1e-13);
  EXPECT_NEAR(run.observed_by_start(0, 1), s, 1e-13);
  EXPECT_NEAR(run.observed_by_parameters(1, 0), -s * s, 1e-12);
  options.observed = Observed::integral();
  EXPECT_THROW(event_sensitivities<Ball>(ball, thrown, Events{}, options, observe), std::invalid_argument);
}

/// A wall that throws a bob back, with a push that depends on where and when.
SmoothEvent<Bob> wall_of_bob() {
  SmoothEvent<Bob> wall{"wall", [](const EventNode<Bob>& node) { return node.object(0) + 0.2; }};
  wall.direction = Event::Direction::falling;
  wall.kick = [](const EventNode<Bob>& node) {
    VariedVector by(2);
    by << node.momentum(0) * -1.9, node.object(1) * 0.1 + node.time * 0.05;
    return by;
  };
  return wall;
}

TEST(EventSensitivities, AreWhatDifferencesTendTo) {
  const SmoothEvent<Bob> wall = wall_of_bob();
  const auto run = [&](Vector<double, 2> q, Vector<double, 2> mu, double stiffness) {
    Bob bob;
    bob.h = 0.07;
    bob.stiffness = stiffness;
    return event_sensitivities(bob, {q, mu}, std::vector{wall}, {.steps = 150, .parameters = {"stiffness"}});
  };
  const Vector<double, 2> q(0.6, -0.5), mu(-0.4, 0.2);
  const EventSensitivities at = run(q, mu, 3);
  ASSERT_TRUE(at.converged()) << at.message;
  ASSERT_GE(at.happened.size(), 2u);
  for (int i = 0; i < 5; ++i) {
    const auto time = [&](double by, std::size_t which) {
      Vector<double, 2> q_of = q, mu_of = mu;
      if (i < 2)
        q_of(i) += by;
      else if (i < 4)
        mu_of(i - 2) += by;
      return run(q_of, mu_of, i == 4 ? 3 + by : 3).happened.at(which).time;
    };
    for (const std::size_t which : {0u, 1u}) {
      const auto difference = [&](double by) { return (time(by, which) - time(-by, which)) / (2 * by); };
      const double limit = (4 * difference(1e-4) - difference(2e-4)) / 3;
      const double exact = i < 4 ? at.happened[which].by_start(i) : at.happened[which].by_parameters(0);
      EXPECT_NEAR(exact, limit, 1e-8 * (1 + std::abs(limit))) << i << ", " << which;
    }
  }
}

/// Under another gravity below a height, which depends on when it comes there and how fast; by the formula of
/// parabolas.
TEST(EventSensitivities, OfWhatIsSetOnTheWayAreThoseOfTheFormula) {
  Ball ball;
  ball.h = 0.11;
  SmoothEvent<Ball> below{"below", [](const EventNode<Ball>& node) { return node.object(0) - 0.5; }};
  below.direction = Event::Direction::falling;
  const auto gravity_of = [](const auto& time, const auto& momentum) { return time * 0.7 - momentum * 0.4 + 1.0; };
  below.set = {{"gravity",
                [&](const EventNode<Ball>& node) -> VariedNumber { return gravity_of(node.time, node.momentum(0)); }}};
  const double q = 0.5, v = 0.3, g = 2, root = std::sqrt(v * v + 2 * g * q), t = (v + root) / g, rest = 17 * 0.11 - t;
  const Eigen::RowVector3d by_root(g / root, v / root, q / root);
  const Eigen::RowVector3d by_t(1 / root, (1 + v / root) / g, q / root / g - t / g);
  const double other = gravity_of(t, -root);
  const Eigen::RowVector3d by_other = 0.7 * by_t + 0.4 * by_root;
  // 0.5 - root (T - t) - g' (T - t)^2 / 2, momentum -root - g' (T - t).
  Eigen::Matrix<double, 2, 3> exact;
  exact << (root + other * rest) * by_t - rest * by_root - rest * rest / 2 * by_other,
      other * by_t - by_root - rest * by_other;
  const EventSensitivities end =
      event_sensitivities(ball, thrown, Events{below}, {.steps = 17, .parameters = {"gravity"}});
  ASSERT_TRUE(end.converged()) << end.message;
  ASSERT_EQ(end.happened.size(), 1u);
  ASSERT_EQ(end.by_parameters.cols(), 1);
  EXPECT_LT((end.by_start - exact.leftCols<2>()).norm(), 1e-11);
  EXPECT_LT((end.by_parameters - exact.rightCols<1>()).norm(), 1e-11);
  // Whether its gravity is asked for is all the same to the start.
  const EventSensitivities start = event_sensitivities(ball, thrown, Events{below}, {.steps = 17});
  ASSERT_TRUE(start.converged()) << start.message;
  EXPECT_EQ(start.by_parameters.cols(), 0);
  EXPECT_LT((start.by_start - end.by_start).norm(), 1e-13);
  // The same number, as one that depends on nothing, misses them.
  below.set[0].number = [other](const EventNode<Ball>&) { return VariedNumber(other); };
  const EventSensitivities held = event_sensitivities(ball, thrown, Events{below}, {.steps = 17});
  ASSERT_TRUE(held.converged()) << held.message;
  EXPECT_GT((held.by_start - end.by_start).norm(), 0.1);
}

TEST(EventSensitivities, OfWhatIsSetAndKickedAreWhatDifferencesTendTo) {
  // A wall makes the spring that pulls the bob back another one at each blow.
  SmoothEvent<Bob> wall{"wall", [](const EventNode<Bob>& node) { return node.object(0) + 0.2; }};
  wall.direction = Event::Direction::falling;
  wall.kick = [](const EventNode<Bob>& node) {
    VariedVector by(2);
    by << node.momentum(0) * -1.9, node.object(1) * 0.1;
    return by;
  };
  wall.set = {{"stiffness", [](const EventNode<Bob>& node) -> VariedNumber {
                 return node.momentum(0) * node.momentum(0) * 0.5 + node.object(1) * 0.3 + node.time * 0.1 + 2.0;
               }}};
  const auto run = [&](const Eigen::VectorXd& x) {
    Bob bob;
    bob.h = 0.07;
    bob.stiffness = x(4);
    return event_sensitivities(bob, {x.head<2>(), x.segment<2>(2)}, std::vector{wall},
                               {.steps = 150, .parameters = {"stiffness"}});
  };
  Eigen::VectorXd x(5);
  x << 0.6, -0.5, -0.4, 0.2, 3;
  const EventSensitivities at = run(x);
  ASSERT_TRUE(at.converged()) << at.message;
  ASSERT_GE(at.happened.size(), 2u);
  for (int i = 0; i < 5; ++i)
    for (const std::size_t which : {0u, 1u}) {
      const auto difference = [&](double by) {
        const Eigen::VectorXd step = Eigen::VectorXd::Unit(5, i) * by;
        return (run(x + step).happened.at(which).time - run(x - step).happened.at(which).time) / (2 * by);
      };
      const double limit = (4 * difference(1e-4) - difference(2e-4)) / 3;
      const double exact = i < 4 ? at.happened[which].by_start(i) : at.happened[which].by_parameters(0);
      EXPECT_NEAR(exact, limit, 1e-8 * (1 + std::abs(limit))) << i << ", " << which;
    }
}

/// The same by steps composed of five and of seventeen arrows, some of them backward in time.
TEST(EventSensitivities, OfComposedStepsAreWhatDifferencesTendTo) {
  SmoothEvent<Bob> wall = wall_of_bob();
  wall.set = {{"stiffness", [](const EventNode<Bob>& node) -> VariedNumber { return node.momentum(0) * 0.2 + 3.0; }}};
  const auto observe = [](const EventNode<Bob>& node) {
    VariedVector all(4);
    all << node.object, node.momentum;
    return all;
  };
  for (const Composition* composition : {&compositions::suzuki, &compositions::kahan_li_8}) {
    const auto run = [&](const Eigen::VectorXd& x) {
      Bob bob;
      bob.h = 0.11;
      bob.stiffness = x(4);
      const State<Pair<2>> start{x.head<2>(), x.segment<2>(2)};
      auto integrator = std::make_unique<detail::IntegratorOf<Bob, CompositionIntegrator<Bob>>>(
          bob, start, Pair<2>::unit(start.object), *composition, [] { return std::make_unique<NewtonStep<Bob>>(); });
      return event_sensitivities<Bob>(bob, std::move(integrator), std::vector{wall},
                                      {.steps = 90, .parameters = {"stiffness"}}, observe);
    };
    Eigen::VectorXd x(5);
    x << 0.6, -0.5, -0.4, 0.2, 3;
    const EventSensitivities at = run(x);
    ASSERT_TRUE(at.converged()) << at.message;
    ASSERT_GE(at.happened.size(), 2u);
    for (int i = 0; i < 5; ++i) {
      const auto all_of = [](const EventSensitivities& of) {
        Eigen::VectorXd all(6);
        all << of.happened.at(0).time, of.happened.at(1).time, of.observed;
        return all;
      };
      const auto difference = [&](double by) -> Eigen::VectorXd {
        const Eigen::VectorXd step = Eigen::VectorXd::Unit(5, i) * by;
        return (all_of(run(x + step)) - all_of(run(x - step))) / (2 * by);
      };
      const Eigen::VectorXd limit = (4 * difference(1e-4) - difference(2e-4)) / 3;
      Eigen::VectorXd exact(6);
      const auto column = [&](const auto& by_start, const auto& by_parameters) -> Eigen::VectorXd {
        return i < 4 ? by_start.col(i) : by_parameters.col(0);
      };
      exact << column(at.happened[0].by_start, at.happened[0].by_parameters),
          column(at.happened[1].by_start, at.happened[1].by_parameters),
          column(at.observed_by_start, at.observed_by_parameters);
      EXPECT_LT((exact - limit).norm(), 1e-8 * (1 + limit.norm())) << i << ", " << composition->name;
    }
  }
}

/// Back from few states that are kept, so that steps are made again from where numbers had been set or had not yet.
TEST(EventSensitivities, GoBackAsTheyGoForward) {
  Bob bob;
  bob.h = 0.11;
  const State<Pair<2>> start{{0.6, -0.5}, {-0.4, 0.2}};
  const auto observe = [](const EventNode<Bob>& node) {
    VariedVector all(4);
    all << node.object, node.momentum;
    return all;
  };
  ObservedEvent wall{.name = "wall", .function = [](const VariedVector& seen) { return VariedNumber(seen(1) + 0.2); }};
  wall.direction = Event::Direction::falling;
  wall.kick = [](const VariedVector& seen) {
    VariedVector by(2);
    by << seen(3) * -1.9, seen(2) * 0.1 + seen(0) * 0.05;
    return by;
  };
  wall.set = {{"stiffness", [](const VariedVector& seen) { return VariedNumber(seen(3) * 0.2 + 3.0); }}};
  for (const Composition* composition : {&compositions::single, &compositions::suzuki}) {
    const auto begun = [&] {
      auto integrator = std::make_unique<detail::IntegratorOf<Bob, CompositionIntegrator<Bob>>>(
          bob, start, Pair<2>::unit(start.object), *composition, [] { return std::make_unique<NewtonStep<Bob>>(); });
      return MotionThroughEvents(
          std::make_unique<CuttableVariational<Bob>>(bob, std::move(integrator), std::vector<std::string>{"stiffness"},
                                                     std::vector<std::string>{"stiffness"}, observe),
          {wall});
    };
    for (const Observed& observed : {Observed::at_end(), Observed::at_node(61), Observed::integral()}) {
      MotionThroughEvents one = begun(), other = begun();
      const Propagated forward = propagate_forward(one, 90, Eigen::MatrixXd::Identity(5, 5), observed);
      const Propagated backward = propagate_backward(other, 90, observed, {5});
      ASSERT_TRUE(forward.converged() && backward.converged()) << forward.message << backward.message;
      EXPECT_LT((forward.values - backward.values).norm(), 1e-13 * (1 + forward.values.norm()));
      EXPECT_LT((forward.derivatives - backward.derivatives).norm(), 1e-11 * forward.derivatives.norm());
    }
    MotionThroughEvents told = begun();
    EXPECT_GE(told.run(90, Eigen::MatrixXd::Identity(5, 5)).happened.size(), 2u);
  }
}

/// At given times, which are those of nodes but for rounding.
TEST(EventSensitivities, GoThroughKicksAtTheTimesOfNodes) {
  Bob bob;
  bob.h = 0.1;
  const State<Pair<2>> start{{0.6, -0.5}, {-0.4, 0.2}};
  for (int k = 1; k < 60; ++k) {
    SmoothEvent<Bob> kick{"kick", [k](const EventNode<Bob>& node) { return node.time - k / 10.0; }};
    kick.kick = [](const EventNode<Bob>& node) { return VariedVector(node.momentum * VariedNumber(0.1)); };
    const EventSensitivities run = event_sensitivities(bob, start, std::vector{kick}, {.steps = k + 3});
    ASSERT_TRUE(run.converged()) << k << ": " << run.message;
    EXPECT_EQ(run.happened.size(), 1u) << k;
  }
}

/// It reads its gravity as a plain number.
struct PlainBall : MechanicalSystem<PlainBall, 1> {
  double gravity = 2;
  Vector<double, 2> winds{0, 0};
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 1>& q) const { return q(0) * gravity; }
  static auto parameters() {
    return std::tuple(parameter("gravity", &PlainBall::gravity, "m/s^2", "acceleration", positive),
                      parameter("winds", &PlainBall::winds, "m/s", "that blow from nowhere"));
  }
};

TEST(EventSensitivities, OfPlainNumbersAreRefusedWhereTheyVary) {
  PlainBall ball;
  ball.h = 0.11;
  using Node = EventNode<PlainBall>;
  SmoothEvent<PlainBall> below{"below", [](const Node& node) { return node.object(0) - 0.5; }};
  const auto run = [&](const std::vector<std::string>& parameters = {}) {
    return event_sensitivities(ball, thrown, std::vector{below}, {.steps = 17, .parameters = parameters});
  };
  EXPECT_THROW(run({"gravity"}), WithoutDerivative);
  below.set = {{"gravity", [](const Node&) { return VariedNumber(1.5); }}};
  EXPECT_TRUE(run().converged());  // a number that depends on nothing
  below.set[0].number = [](const Node& node) -> VariedNumber { return node.time * 0.1 + 1.5; };
  EXPECT_THROW(run(), WithoutDerivative);
  below.set[0].number = [](const Node&) { return VariedNumber(-1); };
  const EventSensitivities negative = run();
  EXPECT_EQ(negative.status, SolveStatus::left_domain);
  EXPECT_NE(negative.message.find("gravity becomes -1, and is to be positive"), std::string::npos) << negative.message;
  for (const char* name : {"winds", "mass"}) {
    below.set[0].name = name;
    EXPECT_THROW(run(), std::invalid_argument) << name;
  }
}

/// A stop at the bottom that throws the bob back: of a pendulum, the times of its first two blows by its start and a
/// parameter beside differences of runs.
template <class Sys> void compare_with_differences(double Sys::*member, const std::string& name) {
  SmoothEvent<Sys> stop{"stop", [](const EventNode<Sys>& node) { return node.object(0); }};
  stop.direction = Event::Direction::falling;
  stop.kick = [](const EventNode<Sys>& node) { return VariedVector(node.momentum * VariedNumber(-1.8)); };
  const auto run = [&](double q, double mu, double by) {
    Sys system;
    system.h = 0.05;
    system.*member += by;
    return event_sensitivities(system, {Vector<double, 1>(q), Vector<double, 1>(mu)}, std::vector{stop},
                               {.steps = 150, .parameters = {name}});
  };
  const EventSensitivities at = run(1, 0.2, 0);
  ASSERT_TRUE(at.converged()) << at.message;
  ASSERT_GE(at.happened.size(), 2u);
  for (const std::size_t which : {0u, 1u})
    for (int i = 0; i < 3; ++i) {
      const auto time = [&](double by) {
        return run(i == 0 ? 1 + by : 1, i == 1 ? 0.2 + by : 0.2, i == 2 ? by : 0).happened.at(which).time;
      };
      const auto difference = [&](double by) { return (time(by) - time(-by)) / (2 * by); };
      const double limit = (4 * difference(1e-4) - difference(2e-4)) / 3;
      const double exact = i < 2 ? at.happened[which].by_start(i) : at.happened[which].by_parameters(0);
      EXPECT_NEAR(exact, limit, 1e-8 * (1 + std::abs(limit))) << name << ' ' << i << ", blow " << which;
    }
}

TEST(EventSensitivities, OfForcedAndDrivenSystemsAreWhatDifferencesTendTo) {
  compare_with_differences(&DampedPendulum::damping, "damping");
  compare_with_differences(&DrivenPendulum::torque, "torque");
}

/// A force that reads the step's size as a plain number.
struct Braked : Ball {
  template <class S> Forces<S, 1> forces(const PairArrow<S, 1>& g) const {
    const Vector<S, 1> half = (g.target - g.source) * (-0.1 / h);
    return {half, half};
  }
};

TEST(EventSensitivities, StepsThatForcesReadAsPlainNumbersAreRefused) {
  Braked ball;
  ball.h = 0.11;
  const SmoothEvent<Braked> floor{"floor", [](const EventNode<Braked>& node) { return node.object(0); }};
  EXPECT_THROW(event_sensitivities(ball, thrown, std::vector{floor}, {.steps = 30}), WithoutDerivative);
}

TEST(EventSensitivities, BetweenEventsTheMatrixIsSymplecticAndReflectionsKeepArea) {
  Ball ball;
  ball.h = 0.11;
  const EventSensitivities end = event_sensitivities(ball, thrown, Events{bouncing(1)}, {.steps = 60});
  ASSERT_TRUE(end.converged()) << end.message;
  EXPECT_GE(end.happened.size(), 3u);
  EXPECT_NEAR(end.by_start.determinant(), 1, 1e-10);
}

TEST(EventSensitivities, OfWhatOnlyGrazesAreRefusedWhereTheMotionDependsOnIt) {
  Ball ball;
  ball.h = 0.11;
  const State<Pair<1>> up{Vector<double, 1>(0.0), Vector<double, 1>(2.0)};  // to a height of 1
  SmoothEvent<Ball> ceiling{"ceiling", [](const EventNode<Ball>& node) { return node.object(0) - 1.0; }};
  const EventSensitivities touched = event_sensitivities(ball, up, Events{ceiling}, {.steps = 30});
  ASSERT_TRUE(touched.converged()) << touched.message;
  EXPECT_TRUE(touched.happened.empty());
  ASSERT_EQ(touched.notes.size(), 1u);
  EXPECT_NE(touched.notes[0].find("came to zero 1 times"), std::string::npos) << touched.notes[0];
  EXPECT_EQ(touched.by_start, event_sensitivities(ball, up, Events{}, {.steps = 30}).by_start);
  ceiling.then = Event::Then::stop;
  const EventSensitivities grazed = event_sensitivities(ball, up, Events{ceiling}, {.steps = 30});
  EXPECT_EQ(grazed.status, SolveStatus::singular);
  EXPECT_NE(grazed.message.find("event \"ceiling\" only grazes zero"), std::string::npos) << grazed.message;
  // Two that only record have their times; of one that ends the run it is not known which is first.
  SmoothEvent<Ball> end = floor_of_ball();
  const EventSensitivities both = event_sensitivities(ball, thrown, Events{floor_of_ball(), end}, {.steps = 30});
  ASSERT_TRUE(both.converged()) << both.message;
  ASSERT_EQ(both.happened.size(), 2u);
  EXPECT_EQ(both.happened[0].by_start, both.happened[1].by_start);
  end.then = Event::Then::stop;
  const EventSensitivities twice = event_sensitivities(ball, thrown, Events{floor_of_ball(), end}, {.steps = 30});
  EXPECT_EQ(twice.status, SolveStatus::singular);
  EXPECT_NE(twice.message.find("happen together"), std::string::npos) << twice.message;
}

}  // namespace
}  // namespace events_sensitivities_tests
