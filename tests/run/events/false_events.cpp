// What looks like an event and is none: jumps, poles, extrema of round-off, and what is there at the start.
#include "orbits.hpp"

#include <lagroid/run/events/function_watch.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

using namespace lagroid;

namespace events_false_events_tests {
namespace {

using enum Event::Direction;

bool has_note(const RunResult& result, const std::string& words) {
  return std::any_of(result.notes.begin(), result.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

Event extremum(std::string name, std::string when, Event::At at) {
  Event event{std::move(name), std::move(when)};
  event.at = at;
  return event;
}

TEST(Events, JumpsAndPolesAreNoZeros) {
  const RunResult result = turn(70, {event_at_zero("jump", "t > 0.55 ? 1 : -1"), event_at_zero("pole", "tan(t)"),
                                     event_at_zero("cut", "atan2(mu, q)")});
  EXPECT_EQ(result.events.watched[0].count, 0);
  EXPECT_TRUE(has_note(result,
                       "event \"jump\": its function changes sign by a jump or a pole, not through zero, 1 times, "
                       "first in the step to t = 0.6; not counted"));
  const std::vector<double> tangent = times_of(result, "pole");
  ASSERT_EQ(tangent.size(), 2u);
  EXPECT_NEAR(tangent[0], std::numbers::pi, 1e-12);
  EXPECT_TRUE(
      has_note(result, "event \"pole\": its function changes sign by a jump or a pole, not through zero, 2 times"));
  // It begins at zero, has its cut at the left, where q = -1, and is zero again after a turn.
  const std::vector<double> angle = times_of(result, "cut");
  ASSERT_EQ(angle.size(), 1u);
  EXPECT_NEAR(angle[0], 2 * std::numbers::pi, 1e-10);
}

TEST(Events, AnExtremumAtTheStartIsNotCounted) {
  const RunResult result =
      turn(1000, {stop(extremum("top", "q", Event::At::maximum)), extremum("bottom", "q", Event::At::minimum)});
  EXPECT_NEAR(result.final.time, 2 * std::numbers::pi, 1e-9);
  EXPECT_EQ(result.events.watched[0].count, 1);
  EXPECT_EQ(result.events.watched[1].count, 1);
  EXPECT_TRUE(has_note(result, "event \"top\": its function is largest at the start, which is not counted"));
  EXPECT_FALSE(has_note(result, "event \"bottom\": its function is"));
  const std::vector<double>& time = result.trajectory.time;
  EXPECT_EQ(std::adjacent_find(time.begin(), time.end()), time.end());
}

TEST(Events, AnExtremumOfRoundOffIsNoEvent) {
  Orbit system;
  system.h = 0.05;
  const RunResult result = run(system, ellipse,
                               {.steps = 2000,
                                .events = {extremum("least", "q1*mu2 - q2*mu1", Event::At::minimum),
                                           extremum("most", "q1*mu2 - q2*mu1", Event::At::maximum)}});
  EXPECT_EQ(result.events.rows.size(), 0u);
  EXPECT_TRUE(has_note(result, "event \"least\": its function is constant to round-off"));
}

TEST(Events, SignsOfRoundOffAreNoEvents) {
  // On a circle q . mu is zero but for rounding; what decays is small and no rounding.
  Orbit system;
  system.h = 0.05;
  const State<Pair<2>> nearly_circle{{1, 0}, {0, 1.3}};
  Event burn = event_at_zero("burn", "q1*mu1 + q2*mu2", falling);
  for (const char* each : {"mu1", "mu2"})
    burn.kick.push_back(std::string(each) + "*(1/(sqrt(sqrt(q1^2 + q2^2))*sqrt(mu1^2 + mu2^2)) - 1)");
  const RunResult result = run_split(system, nearly_circle, compositions::kahan_li_8,
                                     {.steps = 2000, .events = {burn, event_at_zero("decays", "exp(-2*t)*cos(t)")}});
  ASSERT_TRUE(result.converged()) << result.message;
  EXPECT_LE(result.events.watched[0].count, 2);
  EXPECT_EQ(result.events.watched[1].count, 32);
}

TEST(Events, ASmallExtremumIsFoundInSmallSteps) {
  // Over a step of 1e-5 the distance from the centre bends by 1e-10.
  const RunResult result = turn(400, {extremum("far", "sqrt(q^2 + 1)", Event::At::minimum)}, 1e-5);
  EXPECT_EQ(result.events.rows.size(), 0u);
  Turning system;
  system.h = 1e-5;
  const State<Pair<1>> near{Vector<double, 1>(1e-3), Vector<double, 1>(-1.0)};
  const RunResult passing =
      run_split(system, near, compositions::kahan_li_8,
                {.steps = 400, .events = {extremum("near", "sqrt(q^2 + 1)", Event::At::minimum)}});
  ASSERT_EQ(passing.events.rows.size(), 1u);
  EXPECT_NEAR(passing.events.rows[0].time, std::atan(1e-3), 1e-7);
}

TEST(Events, AMinimumWithAKinkIsFoundAtIt) {
  const RunResult result =
      turn(40, {extremum("kink", "abs(q)", Event::At::minimum), event_at_zero("touched", "abs(q)")});
  const std::vector<double> times = times_of(result, "kink");
  ASSERT_EQ(times.size(), 1u);
  EXPECT_NEAR(times[0], std::numbers::pi / 2, 1e-9);
  EXPECT_EQ(result.events.watched[1].count, 0);
  EXPECT_EQ(result.events.watched[1].touches, 1);
}

TEST(Events, AZeroAtTheLastNodeIsFoundFromBothSides) {
  const RunResult result =
      turn(60, {event_at_zero("up", "t - 6"), event_at_zero("down", "6 - t"), event_at_zero("falls", "6 - t", falling),
                event_at_zero("rises", "6 - t", rising)});
  EXPECT_EQ(result.events.watched[0].count, 1);
  EXPECT_EQ(result.events.watched[1].count, 1);
  EXPECT_EQ(result.events.watched[2].count, 1);
  EXPECT_EQ(result.events.watched[3].count, 0);
  // And no second time in the next step.
  EXPECT_EQ(turn(70, {event_at_zero("down", "6 - t")}).events.watched[0].count, 1);
}

TEST(Events, ATouchInTheFirstStepIsSeen) {
  const RunResult result =
      turn(2, {event_at_zero("touched", "(t - 0.03)^2"), event_at_zero("passed", "(t - 0.03)*(t - 0.04)")});
  EXPECT_EQ(result.events.watched[0].touches, 1);
  EXPECT_EQ(result.events.watched[1].count, 2);
}

TEST(FunctionWatch, ZeroForAWhileIsNoEvent) {
  FunctionWatch watch(event_at_zero("flat", "q"));
  const StepFunction zero = [](double) { return 0; };
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(!watch.next(0, k) || watch.find(zero).empty()) << k;
  EXPECT_TRUE(watch.starts_there());
}

/// A kick at a node leaves a rest of no length, which ends where the function is zero.
TEST(FunctionWatch, WhatPassedAtANodeDoesNotPassThereAgain) {
  for (const double before : {1.0, -1.0}) {
    FunctionWatch watch(event_at_zero("gate", "q"));
    watch.next(before, 0);
    ASSERT_TRUE(watch.next(0, 1));
    const auto found = watch.find([before](double share) { return before * (1 - share); });
    ASSERT_EQ(found.size(), 1U);
    EXPECT_FALSE(watch.next_from(0, found[0].passing, 0, 1));
    EXPECT_TRUE(!watch.next(-before, 2) || watch.find([before](double share) { return -before * share; }).empty());
    ASSERT_TRUE(watch.next(before, 3));
    EXPECT_EQ(watch.find([before](double share) { return before * (2 * share - 1); }).size(), 1U);
  }
}

}  // namespace
}  // namespace events_false_events_tests
