// `lagroid control` with durations that are free.
#include "control_command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>
#include <string>

namespace app_control_free_time_tests {
namespace {

class FreeTime : public control_command_tests::ControlCommand {};

TEST_F(FreeTime, ADurationThatCostsNothingIsRefused) {
  const std::string stop = scene("fastest_stop") + " --set 'parameters.cost=\"effort\"'";
  // From rest to rest, and to rest: the motion waits there.
  expect_refused(stop + " --set 'boundary.start=[0,0]' --set 'boundary.end=[3,0]'",
                 "horizon.free: the motion can wait");
  const Outcome slow = expect_refused(stop, "wait at its end at no cost");
  EXPECT_NE(slow.err.find("parameters.cost = \"time\""), std::string::npos) << slow.err;
  expect_refused(scene("falling_cat") + " --set horizon.free=true", "so that no duration is the best: leave out free");
  const std::string phases =
      "control = 'double_integrator'\n[boundary]\nstart = [0, 0]\nend = [3, 1]\n"
      "[[phase]]\nduration = 2\nfree = true\n[[phase]]\nduration = 2\n";
  expect_refused("control " + write(phases).string(), "phase.0.free: the motion can wait at its start");
  // Between states of motion the time that costs least is one: 3, without a force.
  const Outcome drift =
      run(stop + " --json --set 'boundary.start=[0,1]' --set 'boundary.end=[3,1]' --set horizon.duration=2");
  EXPECT_EQ(drift.code, 0) << drift.err;
  EXPECT_NEAR(nlohmann::json::parse(drift.out).at("duration").get<double>(), 3, 1e-3);
}

// A car that pays for its turns alone takes ever wider ones.
TEST_F(FreeTime, ADurationThatRunsAwayIsNamed) {
  const Outcome wide = run(scene("shortest_way") + " --json --set 'parameters.cost=\"effort\"'");
  EXPECT_EQ(wide.code, 3) << wide.err;
  EXPECT_NE(wide.err.find("the cost falls as the duration grows"), std::string::npos) << wide.err;
  EXPECT_NE(wide.out.find("the cost falls as the duration grows"), std::string::npos) << wide.out;
}

// Back to where it stands, the shortest motion of a car is none; what is meant is the smallest circle.
TEST_F(FreeTime, AMotionThatComesBackIsOneThatMoves) {
  const Outcome circle = run(scene("shortest_way") + " --json --set 'boundary.end=[0,0,0]'");
  ASSERT_EQ(circle.code, 0) << circle.err;
  const auto found = nlohmann::json::parse(circle.out);
  EXPECT_NEAR(found.at("duration").get<double>(), 2 * std::numbers::pi, 1e-6);
  EXPECT_EQ(found.at("costs").at(0), found.at("cost"));
}

TEST_F(FreeTime, ATimeThatGoesToNothingIsRefused) {
  const std::string scene =
      "control = 'double_integrator'\n[parameters]\ncost = 'time'\n[boundary]\nstart = [0, 1]\nend = [0, 0]\n"
      "[horizon]\nduration = 3\nfree = true\nstages = 20\n";
  expect_refused("control " + write(scene).string(),
                 "horizon.free: a control that costs nothing and has not both bounds");
  expect_refused("control " + write(scene + "[bounds]\nu = { max = 1 }\n").string(),
                 "horizon.free: a control that costs nothing and has not both bounds");
  const std::string bounded = "control " + write(scene + "[bounds]\nu = [-1, 1]\n").string();
  expect_refused(bounded + " --set 'boundary.start=[0,0]'", "horizon.free: the end is the start");
  const std::string to_a_free_end =
      "control = 'double_integrator'\n[boundary]\nstart = [0, 0]\nend = [1, 0]\nfree_end = ['x', 'v']\n"
      "end_cost = '10*(x - 1)^2'\n[weights]\nu = 1\ntime = 100\n[horizon]\nduration = 2\nfree = true\nstages = 20\n";
  expect_refused("control " + write(to_a_free_end).string(),
                 "horizon.free: no motion to the end, which is free, is cheaper than none");
  // Where the motion itself takes its time, controls may be as large as they like.
  const Outcome straight =
      run(FreeTime::scene("shortest_way") + " --json --set 'boundary.end=[3,0,0]' --set 'bounds.curvature=[-900,900]'");
  ASSERT_EQ(straight.code, 0) << straight.err;
  EXPECT_NEAR(nlohmann::json::parse(straight.out).at("duration").get<double>(), 3, 1e-6);
}

// A motion that must first go away from its end: of three seconds, and of what would do, it makes nothing.
TEST_F(FreeTime, TooShortAGuessOfTheDurationIsMadeLonger) {
  const double x = -1.192, v = -1.876;
  const double fastest = -v + 2 * std::sqrt(v * v / 2 - x);  // forward, then back
  const Outcome r = run(scene("fastest_stop") + fmt::format(" --set 'boundary.start=[{},{}]' --set "
                                                            "'boundary.end=[0,0]' --set horizon.duration=3 --json",
                                                            x, v));
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_NEAR(nlohmann::json::parse(r.out).at("cost").get<double>(), fastest, 1e-3);
}

TEST_F(FreeTime, AnyGuessOfTheDurationWillDo) {
  for (const char* guess : {"1e-6", "1e6"}) {
    const Outcome r = run(scene("fastest_stop") + " --json --set horizon.duration=" + guess);
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_NEAR(nlohmann::json::parse(r.out).at("cost").get<double>(), 1 + std::numbers::sqrt2, 1e-3) << guess;
  }
  const auto duration = [&](const std::string& set) {
    const Outcome r = run(scene("shortest_way") + " --json --set horizon.duration=1e4 " + set);
    EXPECT_EQ(r.code, 0) << r.err;
    return r.code == 0 ? nlohmann::json::parse(r.out).at("duration").get<double>() : 0;
  };
  EXPECT_NEAR(duration("--set 'boundary.end=[0,0,0]'"), 2 * std::numbers::pi, 1e-6);
  EXPECT_NEAR(duration("--set 'boundary.end=[3,0,0]' --set 'bounds.curvature=[-900,900]'"), 3, 1e-6);
  const Outcome few =
      run(scene("shortest_way") + " --set horizon.duration=1e6 --set solver.starts=1 --set solver.iterations=12");
  EXPECT_EQ(few.code, 3);
  EXPECT_NE(few.err.find("from the guess of 1000000: guess it nearer"), std::string::npos) << few.err;
}

// In place no speed costs most, and by symmetry nothing leads from it.
TEST_F(FreeTime, ACarThatTurnsInPlaceIsNoBest) {
  const Outcome r = run(scene("reeds_shepp") + " --set 'boundary.end=[0,0,1]' --json");
  ASSERT_EQ(r.code, 0) << r.err;
  const auto found = nlohmann::json::parse(r.out);
  EXPECT_LT(found.at("cost").get<double>(), 1.00001);
  EXPECT_FALSE(found.at("saddle").get<bool>());
}

}  // namespace
}  // namespace app_control_free_time_tests
