// Events that change the motion: it goes on from where they happen, and what cannot be is said.
#include "orbits.hpp"

#include <lagroid/run/events/event_watch.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

using namespace lagroid;

namespace events_kicks_tests {
namespace {

using enum Event::Direction;

/// A bob that a wall at the bottom sends back.
Event wall() {
  Event event = event_at_zero("wall", "q", falling);
  event.kick = {"-2*mu"};
  return event;
}

TEST(Events, KicksGoOnFromWhereTheyHappen) {
  const RunResult result = turn(200, {wall()});
  ASSERT_TRUE(result.converged()) << result.message;
  const std::vector<double> times = times_of(result, "wall");
  ASSERT_EQ(times.size(), 6u);
  for (std::size_t i = 0; i < times.size(); ++i)
    EXPECT_NEAR(times[i], std::numbers::pi * (double(i) + 0.5), 1e-10) << i;
  const std::vector<double>& q = result.trajectory.series[0].values;
  for (std::size_t k = 0; k < q.size(); ++k) {
    EXPECT_NEAR(result.trajectory.time[k], 0.1 * double(k), 1e-13);
    EXPECT_NEAR(q[k], std::abs(std::cos(0.1 * double(k))), 1e-10) << k;
  }
}

TEST(Events, AKickAtTheApocentreMakesTheOrbitACircle) {
  Orbit system;
  system.h = 0.05;
  Event fire = event_at_zero("apocentre", "q1*mu1 + q2*mu2", falling);
  const std::string speed = "sqrt(mu1^2 + mu2^2)";
  for (const char* each : {"mu1", "mu2"})
    fire.kick.push_back(fmt::format("{}*(1/(sqrt(sqrt(q1^2 + q2^2))*{}) - 1)", each, speed));
  const State<Pair<2>> start{{1, 0}, {0, 1.2}};
  const RunOptions<Orbit> options{.steps = 1000, .events = {fire}};
  for (const bool by_flows : {false, true}) {
    const RunResult result =
        by_flows ? run_split(system, start, compositions::kahan_li_8, options) : run(system, start, options);
    ASSERT_TRUE(result.converged()) << result.message;
    const double apocentre = 1.44 / (2 - 1.44), tolerance = by_flows ? 1e-7 : 2e-3;
    EXPECT_NEAR(std::hypot(result.final.position[0], result.final.position[1]), apocentre, tolerance * apocentre);
    for (const LedgerEntry& entry : result.ledger.entries) EXPECT_FALSE(entry.broken()) << entry.name;
    const auto angular = std::find_if(result.ledger.entries.begin(), result.ledger.entries.end(),
                                      [](const LedgerEntry& entry) { return entry.name == "angular momentum"; });
    EXPECT_EQ(angular->verdict, "kept");
    EXPECT_NEAR(angular->initial[0], std::sqrt(apocentre), 2 * tolerance);
  }
}

/// Steps that are equal in another time take the energy after the kick.
TEST(Events, AKickGoesOnInTransformedTime) {
  Orbit system;
  system.h = 0.05;
  const double apocentre = 1.44 / (2 - 1.44), speed = 1 / std::sqrt(apocentre);
  Event fire = event_at_zero("apocentre", "q1*mu1 + q2*mu2", falling);
  for (const char* each : {"mu1", "mu2"})
    fire.kick.push_back(fmt::format("{}*({}/sqrt(mu1^2 + mu2^2) - 1)", each, speed));
  const RunResult result = run_transformed(system, {{1, 0}, {0, 1.2}}, compositions::kahan_li_8,
                                           {.steps = 1000, .events = {fire, event_at_zero("axis", "q2", rising)}});
  ASSERT_TRUE(result.converged()) << result.message;
  EXPECT_EQ(result.events.watched[0].count, 1);
  EXPECT_NEAR(std::hypot(result.final.position[0], result.final.position[1]), apocentre, 1e-9);
  for (const LedgerEntry& entry : result.ledger.entries) EXPECT_FALSE(entry.broken()) << entry.name;
  const std::vector<double>& time = result.trajectory.time;
  EXPECT_TRUE(std::is_sorted(time.begin(), time.end()));
  const std::vector<double> rounds = times_of(result, "axis");
  ASSERT_GE(rounds.size(), 3u);
  const double period = 2 * std::numbers::pi * apocentre * std::sqrt(apocentre);
  EXPECT_NEAR(rounds[1] - rounds[0], period, 1e-9);
  EXPECT_NEAR(rounds[2] - rounds[1], period, 1e-9);
}

TEST(Events, KicksThatFollowEachOtherWithoutEndAreSaid) {
  Event event = wall();
  event.direction = both;
  const RunResult result = turn(200, {event});
  EXPECT_FALSE(result.converged());
  EXPECT_EQ(result.message, "event \"wall\": follows its own kicks without end, 100 times between t = 1.5 and 1.6");
  EXPECT_EQ(result.steps, 16);
}

TEST(Events, KicksThatDoNotFitAreRefused) {
  Event event = wall();
  event.kick.push_back("1");
  EXPECT_EQ(message_of({event}), "event \"wall\": its kick has 2 numbers, the momentum has 1");
  event.kick = {"speed"};
  EXPECT_EQ(message_of({event}), "event \"wall\": \"speed\": there is no \"speed\"; there are t, q, mu");
}

TEST(Events, KickedRunsResumeWithTheSameBits) {
  Turning system;
  system.h = 0.1;
  const RunOptions<Turning> options{.steps = 120, .events = {wall()}};
  const auto [whole, resumed] = whole_and_resumed(system, unit_turn, options, 16);  // whose last step has the kick
  EXPECT_EQ(bits_of(whole), bits_of(resumed));
  EXPECT_EQ(whole.events.watched[0].count, 4);
  EXPECT_EQ(resumed.events.watched[0].count, 4);
}

/// As the wall, above.
Event roof(double height) {
  Event event = event_at_zero("roof", fmt::format("q - {}", height), rising);
  event.kick = {"-2*mu"};
  return event;
}

TEST(Events, KicksFollowEachOtherInTheRestOfAStep) {
  // From the wall on the bob goes to and fro in asin(0.1) each way, eight times a step.
  const RunResult result = turn(4, {wall(), roof(0.1)}, 0.8);
  ASSERT_TRUE(result.converged()) << result.message;
  const double way = std::asin(0.1), first = std::numbers::pi / 2;
  ASSERT_EQ(result.events.rows.size(), 17u);
  for (std::size_t i = 0; i < 17; ++i) {
    EXPECT_EQ(result.events.rows[i].event, i % 2) << i;
    EXPECT_NEAR(result.events.rows[i].time, first + way * double(i), 1e-6) << i;
  }
}

TEST(Events, AfterAKickWhatTheSignsDoNotShowIsFound) {
  // The bob leaves the wall and would pass the roof twice before the step ends.
  const RunResult result = turn(1, {wall(), roof(0.99)}, 3.6);
  ASSERT_TRUE(result.converged()) << result.message;
  ASSERT_EQ(result.events.rows.size(), 2u);
  EXPECT_EQ(result.events.rows[1].event, 1u);
  EXPECT_NEAR(result.events.rows[1].time - result.events.rows[0].time, std::asin(0.99), 1e-3);
}

TEST(Events, AKickThatEndsTheRunIsMadeFirst) {
  const RunResult result = turn(200, {stop(wall(), 2)});
  ASSERT_TRUE(result.converged()) << result.message;
  EXPECT_NEAR(result.final.time, 1.5 * std::numbers::pi, 1e-10);
  EXPECT_NEAR(result.final.momentum[0], 1, 1e-10);
  EXPECT_EQ(result.trajectory.series[1].values.back(), result.final.momentum[0]);
  EXPECT_EQ(std::count(result.notes.begin(), result.notes.end(),
                       "event \"wall\": kicked the motion 2 times; the ledger's first values are moved by it"),
            1);
  for (const LedgerEntry& entry : result.ledger.entries) EXPECT_FALSE(entry.broken()) << entry.name;
}

TEST(Events, AllThatHappensWhereARunEndsHasHappened) {
  Event also = wall();
  also.name = "also";
  const RunResult result = turn(200, {stop(event_at_zero("end", "3*q")), also, event_at_zero("later", "q + 0.1")});
  ASSERT_EQ(result.events.rows.size(), 2u);
  EXPECT_EQ(result.events.rows[1].event, 1u);
  EXPECT_TRUE(result.events.rows[1].together);
  EXPECT_NEAR(result.final.momentum[0], 1, 1e-10);
}

TEST(Events, KicksThatAreNoNumbersAreSaid) {
  Event event = wall();
  event.kick = {"log(q - 3)"};
  const RunResult undefined = turn(200, {event});
  EXPECT_FALSE(undefined.converged());
  EXPECT_NE(undefined.message.find("event \"wall\": its kick is no finite number at t = 1.5708: \"log(q - 3)\" is"),
            std::string::npos)
      << undefined.message;
  event.kick = {"1e300"};
  const RunResult huge = turn(200, {event});
  EXPECT_FALSE(huge.converged());
  EXPECT_NE(huge.message.find("after its change, between t = 1.5 and 1.6, the rest of the step does not"),
            std::string::npos)
      << huge.message;
}

TEST(Events, WhatIsSummedUpOverStepsIsNotJudgedAfterAKick) {
  DampedPendulum system;
  system.h = 0.02;
  const State<Pair<1>> start{Vector<double, 1>(1.0), Vector<double, 1>(0.0)};
  const auto verdict = [&](std::vector<Event> events) {
    const RunResult result = run(system, start, {.steps = 1500, .events = std::move(events)});
    EXPECT_TRUE(result.converged()) << result.message;
    const auto& entries = result.ledger.entries;
    return std::find_if(entries.begin(), entries.end(),
                        [](const LedgerEntry& e) { return e.name == "energy less work"; })
        ->verdict;
  };
  EXPECT_EQ(verdict({}), "bounded");
  EXPECT_EQ(verdict({event_at_zero("seen", "q")}), "bounded");
  Event push = event_at_zero("push", "q", rising);
  push.kick = {"0.3"};
  EXPECT_EQ(verdict({push}), "unjudged");
}

/// A pendulum whose gravity changes at an angle: the energy that it has then is kept from there.
Event moon(const std::string& when) {
  Event event = event_at_zero("moon", when);
  event.set = {{"gravity", "0.25*(1 + 0*q)"}};
  return event;
}

TEST(Events, ChangeParametersOnTheWay) {
  Pendulum system;
  system.h = 0.01;
  const State<Pair<1>> start{Vector<double, 1>(0.8), Vector<double, 1>(0.3)};
  Event once = moon("t - 3.7");
  const RunResult result = run(system, start, {.steps = 3000, .events = {once}});
  ASSERT_TRUE(result.converged()) << result.message;
  ASSERT_EQ(result.events.rows.size(), 1u);
  // The same in two runs: until then, and on from there with the other gravity.
  const RunResult first = run(system, start, {.steps = 3000, .events = {stop(event_at_zero("then", "t - 3.7"))}});
  EXPECT_EQ(first.final.position[0], result.events.rows[0].values[0]);
  Pendulum light = system;
  light.gravity = 0.25;
  const RunResult second =
      run(light, State<Pair<1>>{Vector<double, 1>(first.final.position[0]), Vector<double, 1>(first.final.momentum[0])},
          {.steps = 2630});
  EXPECT_NEAR(result.final.time, 30, 1e-12);
  EXPECT_NEAR(result.final.position[0], second.final.position[0], 1e-10);
  EXPECT_NEAR(result.final.momentum[0], second.final.momentum[0], 1e-10);
  for (const LedgerEntry& entry : result.ledger.entries) {
    EXPECT_FALSE(entry.broken()) << entry.name;
    if (entry.name == "energy") {
      EXPECT_EQ(entry.verdict, "bounded") << entry.reason;
    }
  }
  EXPECT_TRUE(std::any_of(result.notes.begin(), result.notes.end(), [](const std::string& note) {
    return note == "event \"moon\": changed the motion 1 times; the ledger's first values are moved by it";
  }));
}

TEST(Events, ChangedRunsResumeWithTheSameBits) {
  Pendulum system;
  system.h = 0.05;
  const State<Pair<1>> start{Vector<double, 1>(0.8), Vector<double, 1>(0.3)};
  const RunOptions<Pendulum> options{.steps = 120, .events = {moon("t - 1.03")}};
  const auto [whole, resumed] = whole_and_resumed(system, start, options, 60);
  EXPECT_EQ(bits_of(whole), bits_of(resumed));
  EXPECT_EQ(whole.final.position, resumed.final.position);
}

TEST(Events, ParametersThatCannotBeSetAreRefused) {
  Pendulum system;
  system.h = 0.01;
  const State<Pair<1>> start{Vector<double, 1>(0.8), Vector<double, 1>(0.3)};
  Event event = event_at_zero("change", "q");
  event.set = {{"height", "1"}};
  try {
    run(system, start, {.steps = 3000, .events = {event}});
    FAIL();
  } catch (const RunError& error) {
    EXPECT_STREQ(
        error.what(),
        "event \"change\": it sets \"height\", which is no parameter that is a number; there are mass, length, "
        "gravity");
  }
  event.set = {{"mass", "q - 1"}};
  const RunResult negative = run(system, start, {.steps = 3000, .events = {event}});
  EXPECT_FALSE(negative.converged());
  EXPECT_NE(negative.message.find("mass becomes -1, and is to be positive"), std::string::npos) << negative.message;
  EXPECT_EQ(event_setting("gravity = 1.62"), (std::pair<std::string, std::string>("gravity", "1.62")));
  EXPECT_EQ(event_setting("gravity"), std::nullopt);
  EXPECT_EQ(event_setting(" = 2"), std::nullopt);
}

TEST(Events, WhatIsNoNumberAfterAKickIsSaid) {
  Orbit system;
  system.h = 0.05;
  Event event = event_at_zero("blow", "t - 0.52");
  event.kick = {"1e200", "0"};
  const RunResult result = run_split(system, ellipse, compositions::single, {.steps = 100, .events = {event}});
  EXPECT_FALSE(result.converged());
  EXPECT_NE(result.message.find("event \"blow\": after its change at t = 0.52 energy is no finite number any more"),
            std::string::npos)
      << result.message;
}

TEST(Events, ManyKicksLeaveTheLedgerItsVerdicts) {
  Orbit system;
  system.h = 0.05;
  Event thrust = event_at_zero("thrust", "sin(40*t)");
  thrust.kick = {"1e-3*mu1", "1e-3*mu2"};
  Event brake = event_at_zero("brake", "sin(40*t + 1)");
  brake.kick = {"-1e-3*mu1", "-1e-3*mu2"};
  const RunResult result = run(system, ellipse, {.steps = 4000, .events = {thrust, brake}});
  ASSERT_TRUE(result.converged()) << result.message;
  EXPECT_GT(result.events.watched[0].count, 2000);
  for (const LedgerEntry& entry : result.ledger.entries) EXPECT_FALSE(entry.broken()) << entry.name;
}

}  // namespace
}  // namespace events_kicks_tests
