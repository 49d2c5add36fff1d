// What events promise: the run does not notice them, they come in their order, and what cannot be found is said.
#include "orbits.hpp"

#include <lagroid/run/events/event_watch.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace lagroid;

namespace events_laws_tests {
namespace {

using enum Event::Direction;

TEST(Events, RecordingThemChangesNoBit) {
  const std::vector<Event> events{event_at_zero("x", "q1"),
                                  event_at_zero("turn", "q1*mu1 + q2*mu2"),
                                  {.name = "near", .when = "sqrt(q1^2 + q2^2)", .at = Event::At::minimum}};
  Orbit system;
  system.h = 0.05;
  const auto by_solves = [&](std::vector<Event> watched) {
    return run(system, ellipse, {.steps = 2000, .events = std::move(watched)});
  };
  const auto by_flows = [&](std::vector<Event> watched) {
    return run_split(system, ellipse, compositions::single, {.steps = 2000, .events = std::move(watched)});
  };
  EXPECT_EQ(bits_of(by_solves({})), bits_of(by_solves(events)));
  EXPECT_EQ(bits_of(by_flows({})), bits_of(by_flows(events)));
  EXPECT_GT(by_solves(events).events.rows.size(), 80u);
}

TEST(Events, EnergyAndMomentaOfManyAreThoseWithoutThem) {
  Orbit system;
  system.h = 0.1;
  const State<Pair<2>> circle{{1, 0}, {0, 1}};
  const RunOptions<Orbit> without{.steps = 160'000, .every = 160'000};
  RunOptions<Orbit> with = without;
  for (const char* when : {"q1", "q2", "mu1 - 0.3", "q1 - q2", "q1 + q2"}) with.events.push_back({when, when});
  const RunResult all = run_split(system, circle, compositions::single, with);
  EXPECT_GT(all.events.rows.size(), 20'000u);
  EXPECT_EQ(bits_of(all), bits_of(run_split(system, circle, compositions::single, without)));
}

TEST(Events, AreFoundInsideOfStepsInTheirOrder) {
  // In the step from 0.8 to 1.6 all of them happen.
  const RunResult result = turn(2,
                                {event_at_zero("third", "q"), event_at_zero("first", "q - 0.6"),
                                 event_at_zero("second", "0.3 - q"), event_at_zero("never", "q - 2")},
                                0.8);
  ASSERT_EQ(result.events.rows.size(), 3u);
  EXPECT_EQ(result.events.watched[result.events.rows[0].event].name, "first");
  EXPECT_EQ(result.events.watched[result.events.rows[1].event].name, "second");
  EXPECT_EQ(result.events.watched[result.events.rows[2].event].name, "third");
  EXPECT_EQ(result.events.rows[0].passing, Passing::falling);
  EXPECT_EQ(result.events.rows[1].passing, Passing::rising);
  EXPECT_EQ(result.events.rows[0].step, 2);
  EXPECT_NEAR(result.events.rows[2].time, std::numbers::pi / 2, 1e-5);
  EXPECT_EQ(result.events.watched[3].count, 0);
}

TEST(Events, ThatComeTogetherAreMarkedInTheOrderInWhichTheyWereWritten) {
  const RunResult result =
      turn(20, {event_at_zero("b", "2*q - 0.6"), event_at_zero("a", "q - 0.3"), event_at_zero("c", "q - 0.29")});
  ASSERT_EQ(result.events.rows.size(), 3u);
  EXPECT_EQ(result.events.rows[0].event, 0u);
  EXPECT_FALSE(result.events.rows[0].together);
  EXPECT_EQ(result.events.rows[1].event, 1u);
  EXPECT_TRUE(result.events.rows[1].together);
  EXPECT_FALSE(result.events.rows[2].together);
}

TEST(Events, TwoThatTheSignsAtBothNodesDoNotShowAreFound) {
  // q = cos t is above 0.999 within 0.0447 of 2 pi, and nodes are 0.1 apart.
  const RunResult result = turn(70, {event_at_zero("top", "q - 0.9999")});
  const double away = std::acos(0.9999), round = 2 * std::numbers::pi;
  const std::vector<double> times = times_of(result, "top");
  ASSERT_EQ(times.size(), 3u);  // it begins at the top
  EXPECT_NEAR(times[0], away, 1e-9);
  EXPECT_NEAR(times[1], round - away, 1e-9);
  EXPECT_NEAR(times[2], round + away, 1e-9);
}

TEST(Events, TouchingZeroIsSaidAndNotCounted) {
  const RunResult result = turn(70, {event_at_zero("grazed", "q^2"), event_at_zero("missed", "q^2 + 1e-6")});
  const EventTable& table = result.events;
  EXPECT_EQ(table.watched[0].count, 0);
  EXPECT_EQ(table.watched[0].touches, 2);
  EXPECT_EQ(table.watched[1].touches, 0);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0].passing, Passing::touching);
  EXPECT_NEAR(table.rows[0].time, std::numbers::pi / 2, 1e-8);
  EXPECT_TRUE(std::any_of(result.notes.begin(), result.notes.end(), [](const std::string& note) {
    return note == "event \"grazed\": its function came to zero 2 times without passing it; not counted";
  }));
}

TEST(Events, AZeroAtTheStartHasNotBeenPassed) {
  const RunResult result = turn(70, {event_at_zero("rest", "mu"), event_at_zero("top", "q - 1")});
  EXPECT_EQ(result.events.watched[0].count, 2);
  EXPECT_NEAR(times_of(result, "rest").front(), std::numbers::pi, 1e-10);
  EXPECT_EQ(result.events.watched[1].count, 0);
  EXPECT_EQ(std::count(result.notes.begin(), result.notes.end(),
                       "event \"rest\": its function is zero at the start, which is not counted"),
            1);
}

TEST(Events, EndARunWhereTheyHappen) {
  const RunResult result = turn(1000, {stop(event_at_zero("down", "q", falling), 3), event_at_zero("any", "q")});
  ASSERT_TRUE(result.converged());
  const double there = std::numbers::pi * 4.5;
  EXPECT_NEAR(result.final.time, there, 1e-10);
  EXPECT_NEAR(result.final.position[0], 0, 1e-15);
  EXPECT_EQ(result.trajectory.time.back(), result.final.time);
  EXPECT_EQ(result.steps, 142);
  EXPECT_EQ(result.trajectory.time.size(), 143u);
  EXPECT_EQ(result.events.watched[0].count, 3);
  EXPECT_EQ(result.events.watched[1].count, 5);  // what happens there, too, and nothing that follows
}

TEST(Events, FunctionsInCppAreTakenAndCalledBack) {
  Event event{.name = "functor", .function = [](const Observables& node) {
                double q = 0;
                node.read(0, &q);
                return q;
              }};
  std::vector<double> seen;
  event.call = [&](const Happening& happening, const Observables& inside) {
    EXPECT_EQ(happening.time, inside.time());
    seen.push_back(happening.time);
    return seen.size() < 2;
  };
  const RunResult result = turn(1000, {event});
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_NEAR(seen[1], 1.5 * std::numbers::pi, 1e-10);
  EXPECT_EQ(result.final.time, seen[1]);
}

TEST(Events, ResumedRunsHaveTheBitsOfWholeOnes) {
  Orbit system;
  system.h = 0.1;
  const RunOptions<Orbit> options{.steps = 300,
                                  .events = {event_at_zero("x", "q1"), event_at_zero("near", "q2 - 0.4")}};
  const auto [whole, resumed] = whole_and_resumed(system, ellipse, options, 131);
  EXPECT_EQ(bits_of(whole), bits_of(resumed));
  ASSERT_EQ(whole.events.rows.size(), resumed.events.rows.size());
  for (std::size_t i = 0; i < whole.events.rows.size(); ++i) {
    EXPECT_EQ(whole.events.rows[i].time, resumed.events.rows[i].time);
    EXPECT_EQ(whole.events.rows[i].values, resumed.events.rows[i].values);
    EXPECT_EQ(whole.events.rows[i].event, resumed.events.rows[i].event);
  }
  EXPECT_EQ(whole.events.watched[0].count, resumed.events.watched[0].count);
}

TEST(Events, WhatCannotBeWatchedForIsRefusedInALine) {
  EXPECT_EQ(message_of({event_at_zero("gone", "height - 1")}),
            "event \"gone\": \"height - 1\": there is no \"height\"; there are t, q, mu");
  EXPECT_EQ(message_of({event_at_zero("open", "sin(q")}),
            "event \"open\": \"sin(q\": Missing parenthesis; there are t, q, mu");
  EXPECT_EQ(message_of({event_at_zero("set", "q = 1")}),
            "event \"set\": \"q = 1\": \"=\" sets nothing here: write what is to be zero; there are t, q, mu");
  EXPECT_EQ(message_of({event_at_zero("twice", "q"), event_at_zero("twice", "mu")}),
            "event \"twice\": two have this name");
  for (const char* name : {"", "a, b", "a \"b\"", "a\\b", "a\nb"})
    EXPECT_EQ(message_of({event_at_zero(name, "q")}),
              "an event has a name of one line, without commas, quotes and backslashes");
  EXPECT_EQ(message_of({stop(event_at_zero("none", "q"), 0)}), "event \"none\": it counts to 0, to no event");
}

TEST(Events, WithoutAFiniteFunctionAreSaidAndNothingIsLost) {
  const RunResult result = turn(70, {event_at_zero("root", "sqrt(q) - 0.5"), event_at_zero("never", "log(q - 2)")});
  ASSERT_TRUE(result.converged());
  EXPECT_EQ(result.steps, 70);
  EXPECT_EQ(result.events.watched[0].count, 2);  // where it is defined it is found
  EXPECT_EQ(std::count(result.notes.begin(), result.notes.end(),
                       "event \"never\": its function was no finite number at 71 of 71 nodes, the first at t = 0; "
                       "nothing was found next to them"),
            1);
}

/// Steps that do not converge when they are cut.
class Uncut final : public Motion {
 public:
  explicit Uncut(Motion& whole) : whole_(whole) {}
  std::string name() const override { return whole_.name(); }
  MethodTraits traits() const override { return whole_.traits(); }
  StepReport advance() override { return whole_.advance(); }
  std::string failure(const StepReport& report, long step) const override { return whole_.failure(report, step); }
  long index() const override { return whole_.index(); }
  double time() const override { return whole_.time(); }
  double step_size() const override { return whole_.step_size(); }
  const Observables& look() override { return whole_.look(); }
  std::vector<NamedVector> state() const override { return whole_.state(); }
  std::optional<double> defect() const override { return whole_.defect(); }
  void describe(RunResult& result) const override { whole_.describe(result); }
  void serialize(NumberArchive& archive) override { whole_.serialize(archive); }
  std::string why_not_cut() const override { return why; }

  std::string why;

 private:
  Motion& whole_;
};

TEST(Events, StepsThatCannotBeCutEndTheRunWithTheReason) {
  Turning system;
  system.h = 0.1;
  IntegratorOptions how;
  how.fixed = StepKind::splitting;
  SystemMotion<Turning> whole(system, plain_presentation<Turning>(system, "turning", {}), {},
                              std::make_unique<detail::IntegratorOf<Turning, SplittingIntegrator<Turning>>>(
                                  system, unit_turn, Pair<1>::unit(unit_turn.object), compositions::single),
                              how);
  Uncut motion(whole);
  RunResult result;
  RunExtent extent;
  extent.steps = 30;
  extent.events = {event_at_zero("down", "q")};
  drive(motion, extent, {.record = true}, result);
  EXPECT_FALSE(result.converged());
  // The first step is looked into: nothing is known of how the function bends.
  EXPECT_EQ(result.steps, 1);
  EXPECT_EQ(result.trajectory.time.size(), 2u);
  EXPECT_NE(result.message.find("event \"down\": could not be located between t = 0 and 0.1"), std::string::npos)
      << result.message;
  motion.why = "its steps are whole";
  EXPECT_THROW(drive(motion, extent, {}, result), RunError);
}

/// The nearer to an extremum a zero lies, the less is known of its time.
TEST(Events, TimesErrByRoundingOverTheSlope) {
  for (const double below : {0.5, 1e-4, 1e-8}) {
    const RunResult result = turn(100, {event_at_zero("near the top", fmt::format("q + {:.17g}", 1 - below))});
    ASSERT_GE(result.events.rows.size(), 2u) << below;
    const Happening& row = result.events.rows[0];
    const double slope = std::sqrt(1 - (1 - below) * (1 - below));
    const double exact = std::acos(below - 1);
    EXPECT_LT(row.time_error, 2e-14 / slope) << below;
    EXPECT_GT(row.time_error, 2e-16 / slope) << below;
    EXPECT_NEAR(row.time, exact, 1e-12 / slope) << below;
    EXPECT_NEAR(span_of(result.events, 0)->error * double(result.events.watched[0].count - 1),
                row.time_error + result.events.rows.back().time_error, 1e-20);
  }
  Event lowest{.name = "lowest", .when = "q"};
  lowest.at = Event::At::minimum;
  const RunResult result = turn(100, {lowest});
  ASSERT_GE(result.events.rows.size(), 1u);
  EXPECT_NEAR(result.events.rows[0].time, std::numbers::pi, 1e-9);
  EXPECT_GT(result.events.rows[0].time_error, 1e-14);
  EXPECT_LT(result.events.rows[0].time_error, 1e-9);
}

}  // namespace
}  // namespace events_laws_tests
