// Optimal control on SE(2) and beside it: Dubins' cars, a hovercraft, a sleigh, a car that steers.
#include "support.hpp"

#include <lagroid/systems/control/flows/dubins_car.hpp>
#include <lagroid/systems/control/flows/hovercraft.hpp>
#include <lagroid/systems/control/flows/reeds_shepp_car.hpp>
#include <lagroid/systems/control/flows/steered_car.hpp>
#include <lagroid/systems/control/flows/steered_sleigh.hpp>

#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::optimal_control_poses_tests {
namespace {

using control_tests::expect_laws;
using control_tests::expect_second_order;

ControlTask<DubinsCar> dubins(Vector<double, 3> from, Vector<double, 3> to, double curvature, double guess) {
  ControlTask<DubinsCar> task{{}, FlowStates<SE2>::arrow(from, to), guess, true};
  task.lower(0) = -curvature;
  task.upper(0) = curvature;
  return task;
}

TEST(DubinsCars, FindTheShortestWays) {
  constexpr double pi = std::numbers::pi;
  expect_second_order("right, ahead", dubins({0, 0, 0}, {4, 2, pi / 3}, 1, 5), 4.521646683033829, 0.87, false);
  expect_second_order("back", dubins({0, 0, pi / 2}, {0.5, 0.2, -pi / 2}, 1, 5), 6.7140094618408845, 14.7, false, 12);
  expect_second_order("beside", dubins({0, 0, 0}, {1, 1, -2.5}, 1, 5), 5.639685109805628, 11, false, 12);
  expect_second_order("wide", dubins({1, -1, 2}, {-3, 2, 0.5}, 0.5, 10), 14.698627564994403, 86, false);
  expect_second_order("parallel", dubins({0, 0, 0}, {0, 1.5, 0}, 1, 5), 7.783185307179586, 0.13, false, 12);
  expect_second_order("away", dubins({0, 0, 0.3}, {3, -3, 3}, 1, 6), 6.61794545883391, 1.6, false, 12);
}

// The problem is invariant under SE(2): the costate, carried to where the car started, is one momentum all the way.
TEST(DubinsCars, CostatesConserveTheirMomentum) {
  const auto task = dubins({0, 0, 0}, {4, 2, 1}, 1, 5);
  TranscriptionOf<DubinsCar> transcription(task, straight_trajectory(task, 50));
  InteriorPoint solver(transcription);
  ASSERT_TRUE(solver.solve().converged());
  StageDerivatives derivatives(transcription.sizes());
  transcription.derivatives(solver.costates(), solver.inequality_multipliers(), derivatives);
  const int d = transcription.sizes().variables();
  const auto momenta = [&](const StageRows& costates) {
    std::vector<Vector<double, 3>> all;
    Matrix<double, 3, 3> reached = Matrix<double, 3, 3>::Identity();
    for (long k = 0; k < 50; ++k) {
      reached = SE2::multiply(reached, transcription.trajectory().arrows[std::size_t(k)]);
      Vector<double, 3> at_target = Vector<double, 3>::Zero();
      for (int row = 0; row < 3; ++row)
        for (int i = 0; i < 3; ++i) at_target(i) += costates[k][row] * derivatives.equality[k][row * d + 3 + i];
      all.emplace_back(SE2::adjoint(SE2::inverse(reached)).transpose() * at_target);
    }
    return all;
  };
  const auto spread = [](const std::vector<Vector<double, 3>>& all) {
    double most = 0;
    for (const auto& each : all) most = std::max(most, (each - all.front()).norm());
    return most;
  };
  const auto kept = momenta(solver.costates());
  EXPECT_GT(kept.front().norm(), 0.1);
  EXPECT_LT(spread(kept), 1e-8);
  StageRows wrong = solver.costates();
  wrong[25][1] += 1e-3;
  EXPECT_GT(spread(momenta(wrong)), 1e-4);
}

/// The pieces of a way, by what the control of a stage is called; what is one stage long is left out.
template <class Sys, class Name> std::string pieces_of(const ControlTrajectory<Sys>& way, const Name& name) {
  std::string word;
  std::string piece;
  long stages = 0;
  const auto end = [&] {
    if (stages > 1) word += piece;
  };
  for (const auto& u : way.controls) {
    const std::string here = name(u);
    if (here != piece) {
      end();
      piece = here;
      stages = 0;
    }
    ++stages;
  }
  end();
  return word;
}
std::string turn_of(double u, double largest) { return std::abs(u) < 0.5 * largest ? "S" : u > 0 ? "L" : "R"; }

/// Of a car that goes both ways: where it turns by u, and goes backward, it turns to the other side.
std::string word_of(const ControlTrajectory<ReedsSheppCar>& way, double largest_turn) {
  return pieces_of(way, [&](const Vector<double, 2>& u) {
    return turn_of(u(0) > 0 ? u(1) : -u(1), largest_turn) + (u(0) > 0 ? "+" : "-");
  });
}

/// A way of a car, the length of the shortest, and the words of this length; none: more are than can be told.
struct CarCase {
  Vector<double, 3> from;
  Vector<double, 3> to;
  double largest_turn;
  double length;
  std::vector<std::string> words;
};

/// A way and its word, where a start converged.
template <class Sys> using Found = std::optional<std::pair<ControlTrajectory<Sys>, std::string>>;

/// That `solve` finds them.
template <class Solve> void expect_ways(const std::vector<CarCase>& cases, const Solve& solve) {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto& [from, to, largest_turn, length, words] = cases[i];
    const auto found = solve(cases[i]);
    ASSERT_TRUE(found) << i;
    const auto& [way, word] = *found;
    EXPECT_NEAR(way.duration(), length, 1e-4) << i;
    EXPECT_TRUE(words.empty() || std::count(words.begin(), words.end(), word) == 1) << i << word;
    testing::Test::RecordProperty("length " + std::to_string(i + 1),
                                  fmt::format("{:.17g} {:.17g}", length, way.duration()));
    testing::Test::RecordProperty("word " + std::to_string(i + 1), word);
    if (!words.empty()) continue;
    for (const auto& u : way.controls) EXPECT_NEAR(std::abs(u(u.size() - 1)), largest_turn, 1e-6) << i;
  }
}

// In the second a half turn beside a whole one is as long as three others; in the fourth the last piece is of 0.001.
TEST(DubinsCars, FindTheWordsOfTheShortestWays) {
  constexpr double pi = std::numbers::pi;
  expect_ways({{{0, 0, 0}, {4, 2, pi / 3}, 1, 4.521646683033829, {"LSL"}},
               {{0, 0, 0}, {2, 0, pi}, 1, 2 * pi, {"LRL", "LSR", "RLR", "LR", "RL"}},
               {{0, 0, pi / 2}, {0.5, 0.2, -pi / 2}, 1, 6.7140094618408845, {"LRL"}},
               {{0, 0, 0}, {1, 1, -2.5}, 1, 5.639685109805628, {"RL", "RLR"}},
               {{1, -1, 2}, {-3, 2, 0.5}, 0.5, 14.698627564994403, {"LRL"}},
               {{0, 0, 0}, {0, 1.5, 0}, 1, 7.783185307179586, {"LSL", "RSR"}},
               {{0, 0, 0.3}, {3, -3, 3}, 1, 6.61794545883391, {"RSR"}}},
              [](const CarCase& each) {
                const auto found =
                    search_control(dubins(each.from, each.to, each.largest_turn, 5), 800, {.starts = 12});
                if (found.minima.empty()) return Found<DubinsCar>();
                const auto& way = found.minima.front().trajectory;
                const auto name = [&](const Vector<double, 1>& u) { return turn_of(u(0), each.largest_turn); };
                return Found<DubinsCar>({way, pieces_of(way, name)});
              });
}

// In the third it turns at the full rate all the way, by pi: every such way that arrives is as long.
TEST(ReedsSheppCars, FindTheShortestWaysAndTheirWords) {
  constexpr double pi = std::numbers::pi;
  expect_ways({{{0, 0, 0}, {4, 2, pi / 3}, 1, 4.521646683033829, {"L+S+L+"}},
               {{0, 0, 0}, {2, 0, pi}, 1, pi, {"L+R-", "R+L-"}},
               {{0, 0, pi / 2}, {0.5, 0.2, -pi / 2}, 1, pi, {}},
               {{0, 0, 0}, {1, 1, -2.5}, 1, 2.5, {"R+L-R+", "L-R+L-", "R+L-"}},
               {{1, -1, 2}, {-3, 2, 0.5}, 0.5, 7.035176444467417, {"L+S+R+L-"}},
               {{0, 0, 0}, {0, 1.5, 0}, 1, 3.177308837657156, {"R+L-R-L+", "R-L+R+L-"}},
               {{0, 0, 0.3}, {3, -3, 3}, 1, 5.239136587440841, {"L+R-S-R-"}}},
              [](const CarCase& each) {
                ControlTask<ReedsSheppCar> task{{}, FlowStates<SE2>::arrow(each.from, each.to), 5, true};
                task.lower << -1, -each.largest_turn;
                task.upper << 1, each.largest_turn;
                const auto found = search_control(task, 400);
                if (found.minima.empty()) return Found<ReedsSheppCar>();
                const auto& way = found.minima.front().trajectory;
                return Found<ReedsSheppCar>({way, word_of(way, each.largest_turn)});
              });
}

// The next word of the seventh case that the records list.
TEST(ReedsSheppCars, CompetingWordsAreListed) {
  ControlTask<ReedsSheppCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0.3}, {3, -3, 3}), 5, true};
  task.lower << -1, -1;
  task.upper << 1, 1;
  const auto found = search_control(task, 200);
  ASSERT_GE(found.minima.size(), 2U);
  EXPECT_NEAR(found.minima[1].trajectory.duration(), 5.555583886437171, 4e-4);
  EXPECT_EQ(word_of(found.minima[1].trajectory, 1), "R+S+R+L-");
}

TEST(ReedsSheppCars, DerivativesAndOptimality) {
  ControlTask<ReedsSheppCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, {4, 2, 1}), 5, true};
  task.lower << -1, -1;
  task.upper << 1, 1;
  expect_laws(task, 20);
}

TEST(Hovercrafts, TurnAndMove) {
  using States = FlowStates<Hovercraft::GroupoidType>;
  States::State end;
  end << 1, 1, -1.5 * std::numbers::pi, 0, 0, 0;
  ControlTask<Hovercraft> task{{}, States::arrow(States::State::Zero(), end), 4};
  expect_second_order("free", task, 2.532569163356292, 52, true);
  task.lower << -1.1, -0.75;
  task.upper << 1.1, 0.75;
  const auto found = search_control(task, 200, {.starts = 6});
  ASSERT_FALSE(found.minima.empty());
  EXPECT_NEAR(found.minima.front().report.cost, 2.5368197962538357, 5 * 52.0 / 4e4);
}

TEST(SteeredSleighs, MoveAside) {
  using States = FlowStates<SteeredSleigh::GroupoidType>;
  States::State end;
  end << 2, 1, 0, 0, 0;
  ControlTask<SteeredSleigh> task{{}, States::arrow(States::State::Zero(), end), 4};
  task.lower << -0.8, -0.25;
  task.upper << 0.8, 0.25;
  expect_second_order("sleigh", task, 1.1091270307157488, 2.1, true, 1);
  expect_laws(task, 20);
}

TEST(SteeredCars, WithABoundOfTheirSteering) {
  using States = FlowStates<SteeredCar::GroupoidType>;
  States::State end;
  end << 3, 1.5, 0, 0, 0;
  ControlTask<SteeredCar> task{{}, States::arrow(States::State::Zero(), end), 5};
  task.system.largest_steering = 0.4;
  expect_second_order("car", task, 6.124938865647869, 116, false, 3);
}

TEST(ControlOnSE2, DerivativesAndOptimality) { expect_laws(dubins({0, 0, 0}, {4, 2, 1}, 1, 5), 20); }

// How far a car ends from a place, and how it is turned there, weighed against the effort of its turns.
TEST(ControlOnSE2, DerivativesAndOptimalityWithACostOfTheEnd) {
  auto task = dubins({0, 0, 0}, {4, 2, 1}, 1, 5);
  task.free_end.fill(true);
  task.end_cost = node_condition<SE2, 1>([]<class S>(const Matrix<S, 3, 3>& p) {
    const S x = p(0, 2) - 3.0, y = p(1, 2) - 2.0;
    return Vector<S, 1>((x * x + y * y + p(1, 0) * 0.5) * 4.0);
  });
  expect_laws(task, 20);
  // Beside a start on a line, from where the way is turned at will, and an end on a circle.
  task.free_start = {true, false, true};
  task.start_condition =
      node_condition<SE2, 1>([]<class S>(const Matrix<S, 3, 3>& p) { return Vector<S, 1>(p(1, 2) + p(0, 2)); });
  task.end_condition = node_condition<SE2, 1>(
      []<class S>(const Matrix<S, 3, 3>& p) { return Vector<S, 1>(p(0, 2) * p(0, 2) + p(1, 2) * p(1, 2) - 9.0); });
  expect_laws(task, 20);
}

}  // namespace
}  // namespace lagroid::optimal_control_poses_tests
