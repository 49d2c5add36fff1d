// Events of the members of ensembles: those of single runs, whatever the lanes and threads.
#include "orbits.hpp"

#include <lagroid/run/events/ensemble_events.hpp>
#include <lagroid/systems/ensembles.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace lagroid;

namespace events_ensembles_tests {
namespace {

using Found = EnsembleHappening<Pendulum>;
using PendulumEvent = EnsembleEvent<Pendulum>;

Pendulum system_of_all() {
  Pendulum system;
  system.h = 0.05;
  return system;
}

/// As many as leave the last register in part empty.
std::vector<State<Pair<1>>> starts() {
  std::vector<State<Pair<1>>> out;
  for (int i = 0; i < 4 * widest_batch + 1; ++i)
    out.push_back({Vector<double, 1>(-1.4 + 0.17 * i), Vector<double, 1>(0.3 - 0.05 * i)});
  return out;
}

PendulumEvent bottom(Event::Direction direction = Event::Direction::both) {
  PendulumEvent event("bottom", [](const auto& node) { return node.state.object(0); });
  event.direction = direction;
  return event;
}

struct Watched {
  Ensemble<Pendulum> ensemble;
  EnsembleWatch<Pendulum> watch;
};
Watched advanced(const std::vector<PendulumEvent>& events, long steps, int threads = 1) {
  const auto initial = starts();
  Watched out{Ensemble<Pendulum>(system_of_all(), initial), {system_of_all(), events, long(initial.size())}};
  EnsembleOptions<Pendulum> options;
  options.threads = threads;
  options.visit = out.watch.visitor();
  for (const long until : {steps / 3, steps}) out.ensemble.advance_to(until, options);
  return out;
}

void expect_the_same(const std::vector<Found>& a, const std::vector<Found>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].member, b[i].member);
    EXPECT_EQ(a[i].event, b[i].event);
    EXPECT_EQ(a[i].time, b[i].time);
    EXPECT_EQ(a[i].state.momentum, b[i].state.momentum);
  }
}

TEST(EnsembleEvents, AreThoseOfSingleRuns) {
  const long steps = 400;
  const auto found = advanced({bottom(Event::Direction::rising),
                               {"high", [](const auto& node) { return node.state.object(0) - 0.4; }}},
                              steps)
                         .watch.happened();
  Event low = event_at_zero("bottom", "q", Event::Direction::rising);
  std::size_t next = 0;
  for (const State<Pair<1>>& start : starts()) {
    const RunResult one =
        run(system_of_all(), start, {.steps = steps, .events = {low, event_at_zero("high", "q - 0.4")}});
    ASSERT_TRUE(one.converged()) << one.message;
    for (const Happening& row : one.events.rows) {
      ASSERT_LT(next, found.size());
      EXPECT_EQ(found[next].event, row.event);
      EXPECT_EQ(found[next].step, row.step);
      EXPECT_EQ(found[next].passing, row.passing);
      EXPECT_TRUE(found[next].converged);
      EXPECT_NEAR(found[next].time, row.time, 1e-10);
      EXPECT_NEAR(found[next].state.momentum(0), row.values[1], 1e-10);
      ++next;
    }
  }
  EXPECT_EQ(next, found.size());
  EXPECT_GT(found.size(), 100u);
}

TEST(EnsembleEvents, ChangeNoBitAndDependOnNoThread) {
  const auto initial = starts();
  Ensemble<Pendulum> alone(system_of_all(), initial);
  alone.advance_to(300);
  const Watched one = advanced({bottom()}, 300), three = advanced({bottom()}, 300, 3);
  for (long i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(alone.state(i).object, one.ensemble.state(i).object) << i;
    EXPECT_EQ(alone.state(i).momentum, three.ensemble.state(i).momentum) << i;
  }
  expect_the_same(one.watch.happened(), three.watch.happened());
}

TEST(EnsembleEvents, AreFoundFromWhereTheWatchIsGiven) {
  const auto initial = starts();
  Ensemble<Pendulum> ensemble(system_of_all(), initial);
  ensemble.advance_to(100);
  EnsembleWatch<Pendulum> watch(system_of_all(), {bottom()}, ensemble.size());
  ensemble.advance_to(300, {.visit = watch.visitor()});
  std::vector<Found> later;
  for (const Found& each : advanced({bottom()}, 300).watch.happened())
    if (each.step > 100) later.push_back(each);
  expect_the_same(watch.happened(), later);
}

TEST(EnsembleEvents, EndMembersAlone) {
  PendulumEvent second = bottom();
  second.then = Event::Then::stop;
  second.count = 2;
  const PendulumEvent after("after", [](const auto& node) { return node.state.object(0) * (node.time - 3.0); });
  const Watched all = advanced({second, after}, 300);
  const Watched free = advanced({bottom()}, 300);
  const auto found = all.watch.happened();
  std::vector<double> ends(std::size_t(all.ensemble.size()));
  std::vector<long> count(ends.size());
  for (const Found& each : found)
    if (each.event == 0 && ++count[std::size_t(each.member)] == 2) ends[std::size_t(each.member)] = each.time;
  long ended = 0;
  for (long i = 0; i < all.ensemble.size(); ++i) {
    const auto member = std::size_t(i);
    EXPECT_EQ(all.ensemble.status(i), SolveStatus::converged);
    EXPECT_EQ(free.ensemble.point(i).index, 300);
    if (count[member] < 2) {  // those that turn over pass the bottom once, or not at all
      EXPECT_EQ(all.ensemble.point(i).index, 300) << i;
      continue;
    }
    ++ended;
    EXPECT_EQ(count[member], 2) << i;
    EXPECT_EQ(all.ensemble.point(i).index, long(std::ceil(ends[member] / 0.05))) << i;
    for (const Found& each : found)
      if (each.member == i) {
        EXPECT_LE(each.time, ends[member]);
      }
  }
  EXPECT_GT(ended, all.ensemble.size() / 2);
}

TEST(EnsembleEvents, JumpsPolesAndZerosAtTheStartAreNone) {
  const auto jump = [](const auto& node) {
    const auto& q = node.state.object(0);
    return 1.0 / q;
  };
  EXPECT_TRUE(advanced({{"pole", jump}}, 300).watch.happened().empty());
  const std::vector<State<Pair<1>>> at_zero(3, {Vector<double, 1>(0.0), Vector<double, 1>(-1.0)});
  Ensemble<Pendulum> ensemble(system_of_all(), at_zero);
  EnsembleWatch<Pendulum> watch(system_of_all(), {bottom()}, 3);
  ensemble.advance_to(20, {.visit = watch.visitor()});
  EXPECT_TRUE(watch.happened().empty());
}

}  // namespace
}  // namespace events_ensembles_tests
