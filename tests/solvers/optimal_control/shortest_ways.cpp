// Dubins' car between poses drawn at random, beside the shortest of its words in closed form (Dubins 1957).
#include "support.hpp"

#include <lagroid/systems/control/flows/dubins_car.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace lagroid::optimal_control_shortest_ways_tests {
namespace {

constexpr double pi = std::numbers::pi;
using Pose = Vector<double, 3>;

double whole_turns_off(double angle) {
  const double left = std::fmod(angle, 2 * pi);
  const double positive = left < 0 ? left + 2 * pi : left;
  return positive > 2 * pi - 1e-9 ? 0 : positive;
}

/// Three pieces, each turning by 1, -1 or 0, from the pose (0, 0, 0), with circles of radius one.
struct Word {
  std::array<int, 3> turns;
  std::array<double, 3> lengths;
  double length() const { return lengths[0] + lengths[1] + lengths[2]; }
  bool leads_to(const Pose& end) const {
    double x = 0, y = 0, angle = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double s = turns[i], l = lengths[i];
      if (s == 0) {
        x += l * std::cos(angle);
        y += l * std::sin(angle);
        continue;
      }
      x += s * (std::sin(angle + s * l) - std::sin(angle));
      y -= s * (std::cos(angle + s * l) - std::cos(angle));
      angle += s * l;
    }
    return std::hypot(x - end(0), y - end(1)) < 1e-7 && std::abs(std::remainder(angle - end(2), 2 * pi)) < 1e-7;
  }
};

/// That of the shortest word that leads there, from the circles on which it begins and ends.
double shortest_length(const Pose& end) {
  double shortest = HUGE_VAL;
  const auto take = [&](int first, int middle, int last, double a, double b, double c) {
    const Word word{{first, middle, last},
                    {whole_turns_off(a), middle == 0 ? b : whole_turns_off(b), whole_turns_off(c)}};
    if (word.leads_to(end)) shortest = std::min(shortest, word.length());
  };
  for (const int first : {1, -1})
    for (const int last : {1, -1}) {
      const double x = end(0) - last * std::sin(end(2)), y = end(1) + last * std::cos(end(2));  // the last centre
      const double apart = std::hypot(x, y - first), along = std::atan2(y - first, x);
      if (first != last) {
        if (apart < 2) continue;
        const double straight = std::sqrt(apart * apart - 4);
        const double heading = along + first * std::atan2(2.0, straight);
        take(first, 0, last, first * heading, straight, last * (end(2) - heading));
        continue;
      }
      take(first, 0, last, first * along, apart, last * (end(2) - along));
      if (apart > 4) continue;
      for (const int side : {1, -1}) {
        const double to_middle = along + side * std::acos(apart / 4);
        const double from_middle = std::atan2(y - first - 2 * std::sin(to_middle), x - 2 * std::cos(to_middle));
        const double heading = to_middle + first * pi / 2, next = from_middle - first * pi / 2;
        take(first, -first, first, first * heading, -first * (next - heading), first * (end(2) - next));
      }
    }
  return shortest;
}

TEST(ShortestWays, AreFoundBetweenRandomPoses) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> uniform(-3, 3);
  constexpr int poses = 15;
  int found = 0;
  for (int k = 0; k < poses; ++k) {
    Pose end;
    for (double& x : end) x = uniform(generator);
    ControlTask<DubinsCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, end), 5, true};
    task.lower(0) = -1;
    task.upper(0) = 1;
    const ControlSearch<DubinsCar> search = search_control(task, 100, {.starts = 40});
    ASSERT_FALSE(search.minima.empty()) << end.transpose();
    const double length = search.minima.front().report.cost, shortest = shortest_length(end);
    EXPECT_GT(length, shortest - 0.02) << end.transpose();
    found += length < shortest + 0.02 ? 1 : 0;
  }
  EXPECT_GE(found, poses - 1);  // which minima starts find is chance
}

// What bends of the straight way do not lead to: motions whose controls jump do.
TEST(ShortestWays, OfThreeArcsAreFound) {
  for (const Pose& end : {Pose(0.93, 1.844, 2.751), Pose(-2.657, -2.795, -0.657), Pose(0.277, 1.422, 2.401)}) {
    ControlTask<DubinsCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, end), 5, true};
    task.lower(0) = -1;
    task.upper(0) = 1;
    const ControlSearch<DubinsCar> search = search_control(task, 100, {.starts = 30});
    ASSERT_FALSE(search.minima.empty()) << end.transpose();
    EXPECT_NEAR(search.minima.front().report.cost, shortest_length(end), 0.02) << end.transpose();
  }
}

}  // namespace
}  // namespace lagroid::optimal_control_shortest_ways_tests
