// Derivatives of scenes of bodies through events: impacts, kicks, what is let go and what is caught, against
// extrapolated differences of runs from starts and numbers that are drawn, forward against backward, and what has none.
#include <lagroid/run/events/derivatives/motion_through_events.hpp>
#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/sensitivity/linearised_scene.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid::multibody::bodies_tests {
namespace {

using V = VariedNumber;
using Events = std::vector<ObservedEvent>;
template <class S> using Vec3 = Vector<S, 3>;

/// A scene, and the bodies that are looked at.
template <class S> struct Written {
  BasicScene<S> scene = {};
  std::vector<Body> bodies = {};
};

/// What is seen: the time, then of each body its place and its momentum, kinetic and potential energy.
Vec3<V> place(const VariedVector& seen, int body) { return seen.segment<3>(1 + 6 * body); }
Vec3<V> momentum(const VariedVector& seen, int body) { return seen.segment<3>(4 + 6 * body); }

/// Two balls on springs that strike each other, once in a while: two events of one function.
struct Colliding {
  static constexpr double h = 0.02;
  static constexpr long steps = 60;
  Options options = {};
  std::vector<double> numbers{1.3, 0.7, 2.0, 0.4};
  template <class S> Written<S> operator()(const std::vector<S>& x) const {
    Written<S> out;
    const Body a = out.scene.point_mass(x[0], {S(0), S(0), S(0.1)}, {S(0.4), S(0.1), S(0.2)});
    const Body b = out.scene.point_mass(x[1], {S(1), S(0.1), S(0.15)}, {S(-1.6), S(0), S(0.1)});
    out.scene.add(BasicSpring<S>{{out.scene.ground({S(-0.5), S(0), S(0)}), a.centre}, x[2], S(0.3)});
    out.scene.add(BasicSpring<S>{{out.scene.ground({S(1.5), S(0), S(0)}), b.centre}, x[2] * 0.7, S(0.4)});
    out.scene.add(BasicPeriodicForce<S>{{b.centre}, {S(0), x[3], S(0)}, S(2), S(0.3)});
    out.bodies = {a, b};
    return out;
  }
  static Events events() {
    const auto distance = [](const VariedVector& seen) {
      using std::sqrt;
      return V(sqrt((place(seen, 1) - place(seen, 0)).squaredNorm()) - 0.35);
    };
    const auto kick = [](const VariedVector& seen, double sign) {
      using std::sqrt;
      const Vec3<V> d = place(seen, 1) - place(seen, 0);
      const Vec3<V> n = d / sqrt(d.squaredNorm());
      return Vec3<V>(n * (n.dot(momentum(seen, 1) - momentum(seen, 0)) * (-0.8 * sign)));
    };
    ObservedEvent one{.name = "a", .when = "distance", .function = distance, .direction = Event::Direction::falling};
    ObservedEvent other = one;
    other.name = "b";
    one.kick = [kick](const VariedVector& seen) {
      VariedVector by = VariedVector::Constant(6, V(0));
      by.head<3>() = kick(seen, -1);
      return by;
    };
    other.kick = [kick](const VariedVector& seen) {
      VariedVector by = VariedVector::Constant(6, V(0));
      by.tail<3>() = kick(seen, 1);
      return by;
    };
    const auto height = [](const VariedVector& seen) { return V(place(seen, 0)(2) + 0.01 * seen(0) - 0.12); };
    return {{.name = "passes", .when = "height", .function = height}, one, other};
  }
};

/// A stick on a hinge, and a bob on a string at its end, which is let go and bounces from a floor.
struct Slung {
  static constexpr double h = 0.02;
  static constexpr long steps = 60;
  Options options = {};
  std::vector<double> numbers{1.1, 0.3, 0.05, 9.0, 0.02};
  template <class S> Written<S> operator()(const std::vector<S>& x) const {
    Written<S> out;
    BasicScene<S>& scene = out.scene;
    const Vector<S, 4> upright(S(1), S(0), S(0), S(0));
    const Body stick = scene.rigid_body(x[0], {S(0.03), x[2], S(0.01)}, {S(0.4), S(0), S(0)}, upright,
                                        Vec3<S>(S(0), S(0), S(1.2)), Vec3<S>(S(0), S(-3), S(0)));
    const Body bob = scene.point_mass(x[1], {S(0.8), S(0.05), S(-0.5)}, {S(0.3), S(0), S(2.4)});
    scene.add(BasicCoincidence<S>{{scene.ground(Vec3<S>::Zero()), scene.point_of(stick, {S(-0.4), S(0), S(0)})}});
    const Site end = scene.point_of(stick, {S(0.4), S(0), S(0)});
    scene.begin_switch("string");
    scene.add(BasicRod<S>{{end, bob.centre}, S(std::hypot(0.05, 0.5))});
    scene.end_switch();
    scene.add(BasicConstantForce<S>{{stick.centre}, {S(0), S(0), -x[0] * x[3]}});
    scene.add(BasicConstantForce<S>{{bob.centre}, {S(0), S(0), -x[1] * x[3]}});
    scene.damp(bob, x[4], S(0));
    out.bodies = {stick, bob};
    return out;
  }
  Events events() const {
    Multibody motion((*this)(numbers).scene, h);  // where its momenta are
    const auto of_bob = Eigen::Index(3 * motion.linear_place(1));
    ObservedEvent release{.name = "release", .when = "going down", .function = [](const VariedVector& seen) {
                            return V(momentum(seen, 1)(2) - 0.1 * momentum(seen, 1)(0));
                          }};
    release.direction = Event::Direction::falling;
    release.switches = {{"string", false}};
    ObservedEvent floor{.name = "floor", .when = "floor", .function = [](const VariedVector& seen) {
                          return V(place(seen, 1)(2) + 0.62);
                        }};
    floor.direction = Event::Direction::falling;
    floor.kick = [of_bob](const VariedVector& seen) {
      VariedVector by = VariedVector::Constant(9, V(0));
      by(of_bob + 2) = momentum(seen, 1)(2) * -1.8;
      return by;
    };
    return {release, floor};
  }
};

/// A bob that flies until a string from a support that moves catches it; a wind begins on the way, at a time.
struct Caught {
  static constexpr double h = 0.02;
  static constexpr long steps = 50;
  Options options = {};
  std::vector<double> numbers{0.8, 3.0, 0.5, 1.2};
  template <class S> Written<S> operator()(const std::vector<S>& x) const {
    Written<S> out;
    BasicScene<S>& scene = out.scene;
    const Body bob = scene.point_mass(x[0], {S(0.3), S(0.1), S(-0.4)}, {S(1.4), S(0.3), S(0.2)});
    const Body weight = scene.point_mass(x[2], {S(-0.5), S(0), S(-0.3)}, {S(0), S(0.2), S(0)});
    const Site support = scene.moving_ground(Vec3<S>::Zero(), {S(0), S(0), S(0.1)}, S(3));
    scene.begin_switch("string", false);
    scene.add(BasicRod<S>{{support, bob.centre}, S(0.9)});
    scene.end_switch();
    scene.add(BasicSpring<S>{{bob.centre, weight.centre}, x[1], S(0.6)});
    scene.begin_switch("wind", false);
    scene.add(BasicPeriodicForce<S>{{bob.centre}, {S(0), x[3], S(0.2)}, S(4), S(0)});
    scene.end_switch();
    out.bodies = {bob, weight};
    return out;
  }
  static Events events() {
    ObservedEvent taut{.name = "taut", .when = "taut", .function = [](const VariedVector& seen) {
                         using std::cos, std::sqrt;
                         Vec3<V> d = place(seen, 0);
                         d(2) -= 0.1 * (1.0 - cos(3.0 * seen(0)));
                         // With a little more, as it is zero but for rounding when the string is taut.
                         return V(sqrt(d.squaredNorm()) - 0.9 + 1e-9 * seen(0));
                       }};
    taut.direction = Event::Direction::rising;
    taut.switches = {{"string", true}};
    ObservedEvent wind{
        .name = "wind", .when = "time", .function = [](const VariedVector& seen) { return V(seen(0) - 0.247); }};
    wind.switches = {{"wind", true}};
    return {taut, wind};
  }
};

/// Steps of order four, cut in all their stages.
struct Composed : Colliding {
  Composed() { options.composition = compositions::suzuki; }
};

template <class Subject>
std::unique_ptr<LinearisedScene> scene_of(const Subject& subject, const Eigen::VectorXd& displacement) {
  const auto write = [subject](const auto& numbers) {
    auto written = subject(numbers);
    std::vector<int> linear;
    for (const Body& body : written.bodies) linear.push_back(written.scene.linear_of(body));
    const auto observe = [bodies = written.bodies, linear](const ObservedScene& node) {
      VariedNumbers out(Eigen::Index(6 * bodies.size() + 2));
      for (std::size_t i = 0; i < bodies.size(); ++i)
        out.segment<6>(Eigen::Index(6 * i)) << node(bodies[i].centre), node.momentum_of(linear[i]);
      out.tail<2>() << node.kinetic, node.potential;
      return out;
    };
    return WrittenScene{std::move(written.scene), observe};
  };
  Multibody motion(subject(subject.numbers).scene, Subject::h, subject.options);
  if (displacement.size() > 0) displace(motion, displacement);
  std::optional<LinearisedScene::Stages> stages;
  if (subject.options.composition.stages() > 1) {
    const auto shares = subject.options.composition.coefficients;
    stages =
        LinearisedScene::Stages{Multibody(subject(subject.numbers).scene, Subject::h), {shares.begin(), shares.end()}};
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < subject.numbers.size(); ++i) names.push_back("number " + std::to_string(i));
  return std::make_unique<LinearisedScene>(std::move(motion), names, subject.numbers, write, std::move(stages));
}
template <class Subject>
MotionThroughEvents motion_of(const Subject& subject, const Events& events, const Eigen::VectorXd& displacement = {}) {
  return {scene_of(subject, displacement), events};
}

/// The start along what its joints allow, and the numbers.
template <class Subject> Eigen::MatrixXd directions_of(const Subject& subject) {
  const auto scene = scene_of(subject, {});
  const int states = scene->states(), all = states + scene->parameters();
  Eigen::MatrixXd out = Eigen::MatrixXd::Identity(all, all);
  out.topLeftCorner(states, states) = scene->allowed_directions();
  return out;
}

/// All that a run has found, in one list, or its derivatives along a direction of start and numbers.
Eigen::VectorXd values_of(const EventSensitivities& run) {
  std::vector<double> out(run.observed.data(), run.observed.data() + run.observed.size());
  for (const auto& each : run.happened) {
    out.push_back(each.time);
    out.insert(out.end(), each.observed.data(), each.observed.data() + each.observed.size());
  }
  return Eigen::Map<const Eigen::VectorXd>(out.data(), Eigen::Index(out.size()));
}
Eigen::VectorXd derivatives_of(const EventSensitivities& run, const Eigen::VectorXd& by) {
  const Eigen::VectorXd start = by.head(run.by_start.cols()), numbers = by.tail(by.size() - start.size());
  std::vector<double> out;
  const auto append = [&](const Eigen::VectorXd& each) {
    out.insert(out.end(), each.data(), each.data() + each.size());
  };
  append(run.observed_by_start * start + run.observed_by_parameters * numbers);
  for (const auto& each : run.happened) {
    out.push_back(each.by_start.dot(start) + each.by_parameters.dot(numbers));
    append(each.observed_by_start * start + each.observed_by_parameters * numbers);
  }
  return Eigen::Map<const Eigen::VectorXd>(out.data(), Eigen::Index(out.size()));
}
template <class Subject> EventSensitivities run_of(const Subject& subject, const Events& events) {
  return motion_of(subject, events).run(Subject::steps, directions_of(subject));
}

bool all_happen(const EventSensitivities& run, const Events& events) {
  std::vector<char> happened(events.size(), 0);
  for (const auto& each : run.happened) happened[each.event] = 1;
  return std::find(happened.begin(), happened.end(), 0) == happened.end();
}

/// The subject with numbers that are drawn, no event near a node: there derivatives have a kink.
template <class Subject> Subject drawn(std::mt19937_64& random, const Events& events) {
  std::uniform_real_distribution<double> by(0.93, 1.07);
  for (;;) {
    Subject out;
    for (double& number : out.numbers) number *= by(random);
    const EventSensitivities run = run_of(out, events);
    bool inside = run.converged() && all_happen(run, events);
    for (const auto& each : run.happened) {
      const double share = each.time / Subject::h - std::floor(each.time / Subject::h);
      inside = inside && 0.1 < share && share < 0.9;
    }
    if (inside) return out;
  }
}

/// How far derivatives are from what differences tend to, over their size.
template <class Subject>
double off_differences(const Subject& subject, const Events& events, const EventSensitivities& exact,
                       const Eigen::VectorXd& by) {
  const Eigen::Index states = exact.by_start.cols();
  const Eigen::VectorXd differences = laws::detail::extrapolated_difference(
      [&](double width) {
        Subject other = subject;
        for (std::size_t i = 0; i < other.numbers.size(); ++i) other.numbers[i] += width * by(states + Eigen::Index(i));
        MotionThroughEvents motion = motion_of(other, events, width * by.head(states));
        const EventSensitivities run = motion.run(Subject::steps, Eigen::MatrixXd(by.size(), 0));
        EXPECT_TRUE(run.converged()) << run.message;
        EXPECT_EQ(run.happened.size(), exact.happened.size());
        return values_of(run);
      },
      4e-4, /*widths=*/4);
  const Eigen::VectorXd found = derivatives_of(exact, by);
  return (differences - found).norm() / found.norm();
}

template <class T> class EventsOfBodies : public testing::Test {};
using Subjects = testing::Types<Colliding, Slung, Caught, Composed>;
TYPED_TEST_SUITE(EventsOfBodies, Subjects);

TYPED_TEST(EventsOfBodies, HaveTheDerivativesThatDifferencesTendTo) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> number;
  const Events events = TypeParam().events();
  for (int draw = 0; draw < 4; ++draw) {
    const TypeParam subject = drawn<TypeParam>(random, events);
    const EventSensitivities exact = run_of(subject, events);
    ASSERT_TRUE(exact.converged()) << exact.message;
    for (int k = 0; k < 3; ++k) {
      Eigen::VectorXd by(exact.by_start.cols() + exact.by_parameters.cols());
      for (Eigen::Index i = 0; i < by.size(); ++i) by(i) = 0.3 * number(random);
      EXPECT_LT(off_differences(subject, events, exact, by), 1e-8) << "draw " << draw << ", direction " << k;
    }
  }
}

/// What is left of a derivative where times of events are held fixed misses the differences.
TYPED_TEST(EventsOfBodies, HeldAtTheirTimesMissTheDifferences) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> number;
  const Events events = TypeParam().events();
  const TypeParam subject = drawn<TypeParam>(random, events);
  EventSensitivities exact = run_of(subject, events);
  Events at_times = events;
  std::vector<double> times;
  for (std::size_t i = 0; i < events.size(); ++i)
    for (const auto& each : exact.happened)
      if (each.event == i && times.size() == i) times.push_back(each.time);
  ASSERT_EQ(times.size(), events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    at_times[i].direction = Event::Direction::rising;
    at_times[i].function = [t = times[i]](const VariedVector& seen) { return V(seen(0) - t); };
  }
  const EventSensitivities held = run_of(subject, at_times);
  // A string that is switched on at a time does not hold from other starts: that is found.
  if (std::is_same_v<TypeParam, Caught>) {
    EXPECT_EQ(held.status, SolveStatus::singular);
    EXPECT_NE(held.message.find("what event \"taut\" switches on would not hold"), std::string::npos) << held.message;
  } else {
    ASSERT_TRUE(held.converged()) << held.message;
    Eigen::VectorXd by(exact.by_start.cols() + exact.by_parameters.cols());
    for (Eigen::Index i = 0; i < by.size(); ++i) by(i) = 0.3 * number(random);
    const Eigen::Index seen = exact.observed.size();
    const Eigen::VectorXd found = derivatives_of(held, by).head(seen), right = derivatives_of(exact, by).head(seen);
    EXPECT_GT((found - right).norm(), 1e-2 * right.norm());
  }
}

TYPED_TEST(EventsOfBodies, AreBackwardWhatTheyAreForward) {
  const TypeParam subject;
  const Events events = subject.events();
  const Eigen::MatrixXd directions = directions_of(subject);
  for (const Observed& observed : {Observed::at_end(), Observed::at_node(40), Observed::integral()}) {
    MotionThroughEvents one = motion_of(subject, events), other = motion_of(subject, events);
    const Propagated forward = propagate_forward(one, TypeParam::steps, directions, observed);
    const Propagated backward = propagate_backward(other, TypeParam::steps, observed, {5});
    ASSERT_TRUE(forward.converged() && backward.converged()) << forward.message << backward.message;
    for (Eigen::Index i = 0; i < forward.values.size(); ++i)
      EXPECT_NEAR(forward.values(i), backward.values(i), 1e-13 * (1 + std::abs(forward.values(i))));
    EXPECT_LT((forward.derivatives - backward.derivatives * directions).norm(), 1e-12 * forward.derivatives.norm());
  }
  // The run that tells of events has the same end.
  const EventSensitivities run = run_of(subject, events);
  EXPECT_TRUE(all_happen(run, events));
  MotionThroughEvents again = motion_of(subject, events);
  const Propagated end = propagate_forward(again, TypeParam::steps, directions);
  Eigen::MatrixXd both(run.observed.size(), directions.cols());
  both << run.observed_by_start, run.observed_by_parameters;
  EXPECT_LT((both - end.derivatives).norm(), 1e-12 * end.derivatives.norm());
}

TEST(EventsOfBodiesThatEnd, HaveTheDerivativesThatDifferencesTendTo) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> number;
  Events events = Slung().events();
  events[1].then = Event::Then::stop;
  const Slung subject = drawn<Slung>(random, events);
  const EventSensitivities exact = run_of(subject, events);
  ASSERT_TRUE(exact.converged() && exact.is_stopped) << exact.message;
  EXPECT_LT(exact.steps, Slung::steps);
  for (int k = 0; k < 3; ++k) {
    Eigen::VectorXd by(exact.by_start.cols() + exact.by_parameters.cols());
    for (Eigen::Index i = 0; i < by.size(); ++i) by(i) = 0.3 * number(random);
    EXPECT_LT(off_differences(subject, events, exact, by), 1e-8) << "direction " << k;
  }
  MotionThroughEvents motion = motion_of(subject, events);
  EXPECT_THROW(propagate_forward(motion, Slung::steps, directions_of(subject)), std::invalid_argument);
}

/// What is expected of a run that has no derivative.
template <class Subject> void expect_none(const Subject& subject, const Events& events, const std::string& words) {
  const EventSensitivities run = run_of(subject, events);
  EXPECT_EQ(run.status, SolveStatus::singular) << words << ", happened " << run.happened.size();
  EXPECT_NE(run.message.find(words), std::string::npos) << run.message;
}

TEST(EventsOfBodiesWithoutDerivative, AreToldInOneLine) {
  const Colliding subject;
  // Both strike at once, by functions of their own.
  Events apart = Colliding::events();
  apart[2].when = "another";
  expect_none(subject, apart, "event \"a\" and event \"b\" happen together");
  // It is zero at the start.
  Events begins = Colliding::events();
  begins[0].function = [](const VariedVector& seen) { return V(place(seen, 0)(0)); };
  begins[0].kick = begins[1].kick;
  expect_none(subject, begins, "event \"passes\" is zero at the start");
  // It only grazes zero: a place at the time at which it turns.
  EventSensitivities turning;
  Events turns = Colliding::events();
  turns.resize(1);
  turns[0].direction = Event::Direction::falling;
  turns[0].function = [](const VariedVector& seen) { return V(momentum(seen, 0)(0)); };
  turning = run_of(subject, turns);
  ASSERT_FALSE(turning.happened.empty());
  const double highest = turning.happened[0].observed(0);
  turns[0].direction = Event::Direction::both;
  turns[0].function = [highest](const VariedVector& seen) { return V(place(seen, 0)(0) - (highest + 1e-7)); };
  turns[0].tolerance = 1e-4;
  const EventSensitivities touched = run_of(subject, turns), without = run_of(subject, {});
  ASSERT_TRUE(touched.converged()) << touched.message;
  EXPECT_TRUE(touched.happened.empty());
  ASSERT_EQ(touched.notes.size(), 1u);
  EXPECT_NE(touched.notes[0].find("came to zero 1 times"), std::string::npos) << touched.notes[0];
  EXPECT_EQ(touched.by_start, without.by_start);
  turns[0].kick = Colliding::events()[1].kick;
  expect_none(subject, turns, "event \"passes\" only grazes zero");
  MotionThroughEvents kicked = motion_of(subject, turns);
  EXPECT_THROW(propagate_backward(kicked, Colliding::steps), EventWithoutDerivative);
  // At a node: its time depends on what is given.
  EventSensitivities at_node = motion_of(subject, {}).run(10, Eigen::MatrixXd(16, 0));
  const double there = at_node.observed(0);
  Events nodes = Colliding::events();
  nodes[0].function = [there](const VariedVector& seen) { return V(place(seen, 0)(0) - there); };
  nodes[0].kick = nodes[1].kick;
  nodes.resize(1);
  expect_none(subject, nodes, "happens at the time of a node");
  // By the time alone it does not, and nothing is wrong with it.
  nodes[0].function = [](const VariedVector& seen) { return V(seen(0) - 10 * Colliding::h); };
  const EventSensitivities timed = run_of(subject, nodes);
  EXPECT_TRUE(timed.converged()) << timed.message;
  ASSERT_EQ(timed.happened.size(), 1u);
  EXPECT_TRUE(timed.happened[0].by_start.isZero(0));
  // A string that is not taut where it is switched on.
  Events taut = Caught::events();
  taut[0].function = [](const VariedVector& seen) { return V(seen(0) - 0.3131); };
  const EventSensitivities slack = run_of(Caught(), taut);
  EXPECT_EQ(slack.status, SolveStatus::left_domain);
  EXPECT_NE(slack.message.find("\"string\" is switched on where it does not hold"), std::string::npos) << slack.message;
  EXPECT_THROW(motion_of(subject, Events{{.name = "none"}}), std::invalid_argument);
}

TEST(EventsOfBodiesWithoutDerivative, AtTheStartAreToldByDirection) {
  // Where it is, the first ball would be kicked at once or not at all; what else varies leaves that as it is.
  const Colliding subject;
  Events begins = Colliding::events();
  begins.resize(1);
  begins[0].function = [](const VariedVector& seen) { return V(place(seen, 0)(0)); };
  begins[0].kick = Colliding::events()[1].kick;
  const Eigen::MatrixXd directions = directions_of(subject);
  MotionThroughEvents asked = motion_of(subject, begins);
  const std::vector<std::string> why = asked.why_none_along(directions);
  ASSERT_EQ(why.size(), std::size_t(directions.cols()));
  std::vector<Eigen::Index> others;
  for (std::size_t k = 0; k < why.size(); ++k)
    if (why[k].empty()) others.push_back(Eigen::Index(k));
  ASSERT_EQ(others.size() + 1, why.size());
  const Eigen::MatrixXd rest = directions(Eigen::all, others);
  MotionThroughEvents motion = motion_of(subject, begins), untold = motion_of(subject, begins),
                      without = motion_of(subject, {});
  EXPECT_THROW(propagate_forward(untold, 10, rest), EventWithoutDerivative);
  motion.begin_along(rest);
  const Propagated found = propagate_forward(motion, 10, rest), expected = propagate_forward(without, 10, rest);
  ASSERT_TRUE(found.converged()) << found.message;
  EXPECT_EQ(found.derivatives, expected.derivatives);
}

}  // namespace
}  // namespace lagroid::multibody::bodies_tests
