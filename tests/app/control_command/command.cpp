// `lagroid control`: every example, files, refusals, endings.
#include "control_command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace app_control_command_tests {
namespace {

class Control : public control_command_tests::ControlCommand {};

TEST_F(Control, EveryExampleFindsAMinimum) {
  int examples = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(LAGROID_EXAMPLES) / "control")) {
    if (entry.path().extension() != ".toml") continue;
    ++examples;
    const std::string name = entry.path().stem();
    const bool has_phases = text_of(name).find("[[phase]]") != std::string::npos;
    const Outcome r = run(scene(name) + " --json" + (has_phases ? "" : " --set horizon.stages=40"));
    ASSERT_EQ(r.code, 0) << name << r.err << r.out;
    const auto found = nlohmann::json::parse(r.out);
    EXPECT_EQ(found.at("status"), "converged") << name;
    if (found.contains("loop")) continue;
    EXPECT_TRUE(found.at("strict_minimum").get<bool>()) << name;
    EXPECT_LT(found.at("violation").get<double>(), 1e-9) << name;
    EXPECT_LT(found.at("complementarity").get<double>(), 1e-9) << name;
    EXPECT_NE(found.at("crossover").at("status"), "not_tried") << name;
    EXPECT_EQ(found.at("costs").at(0), found.at("cost")) << name;
  }
  EXPECT_GE(examples, 9);
}

TEST_F(Control, TheShortestWayBesideIsThreeArcs) {
  const Outcome r = run(scene("shortest_way") + " --json");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_NEAR(nlohmann::json::parse(r.out).at("cost").get<double>(), 7.783185307179586, 1e-4);
}

TEST_F(Control, WritesTrajectoryAndPlotAndRunHandsOver) {
  const std::string out = (folder_ / "stop").string();
  const Outcome r = run("run " + example("control/fastest_stop") + " --out " + out);
  ASSERT_EQ(r.code, 0) << r.err;
  for (const char* name : {"trajectory.csv", "summary.json", "summary.txt", "plot.gp"})
    EXPECT_TRUE(fs::exists(fs::path(out) / name)) << name;
  std::ifstream file(fs::path(out) / "trajectory.csv");
  std::string header;
  std::getline(file, header);
  EXPECT_EQ(header, "time,x,v,u,px,pv");
  long rows = 0;
  for (std::string line; std::getline(file, line);) ++rows;
  EXPECT_EQ(rows, 101);
}

TEST_F(Control, ALoopIsClosedBySolvesOfAFewIterations) {
  const std::string out = (folder_ / "loop").string();
  const std::string loop = scene("control_loop") + " --set horizon.stages=25 --set loop.samples=60";
  const Outcome r = run(loop + " --json --out " + out);
  ASSERT_EQ(r.code, 0) << r.err;
  const auto found = nlohmann::json::parse(r.out).at("loop");
  EXPECT_EQ(found.at("samples"), 60);
  EXPECT_EQ(found.at("not_converged"), 0);
  for (const auto& [count, times] : found.at("iterations").items()) EXPECT_LE(std::stoi(count), 20) << times;
  EXPECT_GE(found.at("seconds").at("longest"), found.at("seconds").at("median"));
  // The end is reached, the bounds are kept, and the third axis stays off the sun.
  std::ifstream file(fs::path(out) / "trajectory.csv");
  std::string line;
  std::getline(file, line);
  std::vector<double> row;
  long rows = 0;
  while (std::getline(file, line)) {
    row.clear();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell.empty() ? 0 : std::stod(cell));
    ++rows;
    for (std::size_t i = 7; i < row.size(); ++i) EXPECT_LE(std::abs(row[i]), 0.6 + 1e-9) << line;
  }
  EXPECT_EQ(rows, 61);
  EXPECT_NEAR(row.at(2), 1.9518, 0.1);
  // The same numbers again, and one iteration a sample.
  const Outcome again = run(loop + " --json");
  EXPECT_EQ(nlohmann::json::parse(again.out).at("cost"), nlohmann::json::parse(r.out).at("cost"));
  const Outcome real_time =
      run(loop + " --json --set loop.iterations=1 --set loop.usable=0.1 --set loop.disturbance=0");
  EXPECT_EQ(real_time.code, 0) << real_time.err;
  EXPECT_EQ(nlohmann::json::parse(real_time.out).at("loop").at("iterations").at("1"), 60);
}

TEST_F(Control, ALoopThatIsLostEndsAndSaysWhere) {
  const Outcome r =
      run(scene("control_loop") + " --json --set horizon.stages=20 --set loop.samples=20 --set loop.disturbance=3");
  EXPECT_EQ(r.code, 3);
  EXPECT_NE(r.err.find("sample "), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("loop.iterations"), std::string::npos) << r.err;
  EXPECT_LT(nlohmann::json::parse(r.out).at("loop").at("samples").get<long>(), 20);
}

// Its first start takes a minute.
TEST_F(Control, AnInterruptEndsASearchInTheMidstOfAStart) {
  const std::string out = (folder_ / "out").string();
  const auto before = std::chrono::steady_clock::now();
  const Outcome r =
      run(scene("arm_of_bodies") + " --set horizon.stages=1500 --out " + out, "timeout --preserve-status -s INT 2 ");
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(20));
  EXPECT_EQ(r.code, 4) << r.err;
  EXPECT_NE(r.err.find("interrupted after "), std::string::npos) << r.err;
  const auto found = nlohmann::json::parse(std::ifstream(out + "/summary.json"));
  EXPECT_EQ(found.at("interrupted"), true);
  EXPECT_EQ(found.at("status"), "interrupted");
  EXPECT_EQ(found.at("starts").at("interrupted"), 1);
  std::ifstream text(out + "/summary.txt");
  EXPECT_NE(std::string(std::istreambuf_iterator<char>(text), {}).find("  interrupted "), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(run(scene("fastest_stop") + " --json").out).at("interrupted"), false);
}

TEST_F(Control, WhatCannotBeIsTypedAndNamed) {
  const Outcome r =
      run(scene("fastest_stop") + " --json --set horizon.free=false --set horizon.duration=1 --set solver.starts=1");
  EXPECT_EQ(r.code, 3);
  const auto found = nlohmann::json::parse(r.out);
  EXPECT_EQ(found.at("status"), "infeasible");
  EXPECT_FALSE(found.at("violated").empty());
  EXPECT_NE(r.err.find("relax the constraints"), std::string::npos) << r.err;
}

/// The rows of a trajectory, an empty cell as zero; first its header.
std::pair<std::string, std::vector<std::vector<double>>> rows_of(const fs::path& folder) {
  std::ifstream file(folder / "trajectory.csv");
  std::string header;
  std::getline(file, header);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::vector<double>& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell.empty() ? 0 : std::stod(cell));
  }
  return {header, rows};
}

// Two impulses in the limit of a large thrust: 0.1816 of velocity, at a thrust of 0.1.
TEST_F(Control, ThrustCoastThrustFindsHowLongEachLasts) {
  const fs::path out = folder_ / "coast";
  const Outcome r = run(scene("low_thrust_coast") + " --json --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err;
  const auto found = nlohmann::json::parse(r.out);
  const auto& phases = found.at("phases");
  ASSERT_EQ(phases.size(), 3U);
  EXPECT_EQ(phases[1].at("name"), "coast");
  EXPECT_EQ(phases[1].at("stages"), 40);
  const double thrust = phases[0].at("duration").get<double>() + phases[2].at("duration").get<double>();
  EXPECT_NEAR(found.at("cost").get<double>(), thrust, 1e-9);
  EXPECT_GT(thrust, 1.816);
  EXPECT_LT(thrust, 1.83);
  const auto [header, rows] = rows_of(out);
  EXPECT_EQ(header.substr(header.rfind(',')), ",phase");
  ASSERT_EQ(rows.size(), 81U);
  for (std::size_t k = 20; k < 60; ++k) {
    EXPECT_EQ(rows[k][5], 0) << k;
    EXPECT_EQ(rows[k][6], 0) << k;
  }
  EXPECT_NEAR(std::hypot(rows.back()[1], rows.back()[2]), 1.5, 1e-9);
  std::ifstream plot(out / "plot.gp");
  const std::string script{std::istreambuf_iterator<char>(plot), {}};
  EXPECT_NE(script.find("set label 'coast'"), std::string::npos);
}

// Two right turns and a line between them, of pi / 2 and the distance of their centers, to the gate at (2, y); then a
// left turn and a line that points to the center of the circle, at (6, 3).
TEST_F(Control, AGateIsPassedWhereTheWayIsShortest) {
  const fs::path out = folder_ / "gate";
  const Outcome r = run(scene("through_a_gate") + " --json --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err;
  const auto found = nlohmann::json::parse(r.out);
  double shortest = 1e9;
  for (double y = 1; y < 2; y += 1e-4) {
    const double to_the_gate = std::acos(-1.0) / 2 + std::hypot(1, y - 1);
    const double apart = std::hypot(4, 2 - y);  // of the circle's center from that of the left turn
    const double to_the_circle = std::atan2(2 - y, 4) + std::asin(1 / apart) + std::sqrt(apart * apart - 1) - 1;
    shortest = std::min(shortest, to_the_gate + to_the_circle);
  }
  EXPECT_NEAR(found.at("cost").get<double>(), shortest, 1e-3);
  const auto rows = rows_of(out).second;
  ASSERT_EQ(rows.size(), 121U);
  EXPECT_NEAR(rows[60][1], 2, 1e-10);
  EXPECT_NEAR(rows[60][3], 0, 1e-10);
  EXPECT_NEAR(std::hypot(rows[120][1] - 6, rows[120][2] - 3), 1, 1e-10);
  const Outcome by_ipopt = run(scene("through_a_gate") + " --json --set solver.method=ipopt");
  if (by_ipopt.code == 2) GTEST_SKIP() << "a build without IPOPT";
  ASSERT_EQ(by_ipopt.code, 0) << by_ipopt.err;
  EXPECT_NEAR(nlohmann::json::parse(by_ipopt.out).at("cost").get<double>(), found.at("cost").get<double>(), 1e-8);
}

TEST_F(Control, BandsAreWhereBoundsAreReached) {
  const auto drawn = [&](const std::string& name, const std::string& more = "") {
    const fs::path out = folder_ / name;
    const Outcome r = run(scene(name) + more + " --out " + out.string());
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_TRUE(fs::exists(out / "plot.svg"));
    std::ifstream plot(out / "plot.gp");
    return std::string{std::istreambuf_iterator<char>(plot), {}};
  };
  const std::string bounded = drawn("fastest_stop");
  EXPECT_NE(bounded.find("set object rectangle from 0, graph 0"), std::string::npos) << bounded;
  EXPECT_NE(bounded.find("set title 'controls, and their bounds; bands: one is reached'"), std::string::npos);
  const std::string free = drawn("rolled_ball", " --set parameters.largest_speed=20");
  EXPECT_EQ(free.find("set object rectangle"), std::string::npos) << free;
}

TEST_F(Control, NamesOfPhasesAreTextToGnuplot) {
  const fs::path out = folder_ / "named";
  const Outcome r = run(scene("through_a_gate") + " --set \"phase.0.name=\\\"driver's way\\\"\" --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err;
  std::ifstream plot(out / "plot.gp");
  const std::string script{std::istreambuf_iterator<char>(plot), {}};
  EXPECT_NE(script.find("set label 'driver''s way'"), std::string::npos);
  EXPECT_TRUE(fs::exists(out / "plot.svg"));
}

TEST_F(Control, MistakesOfPhasesAndEndsAreOneLine) {
  const auto refused = [&](const std::string& name, const std::string& set, const std::string& words) {
    const Outcome r = run(scene(name) + " --set '" + set + "'");
    EXPECT_EQ(r.code, 2) << set << r.err;
    EXPECT_NE(r.err.find(words), std::string::npos) << set << ": " << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  };
  refused("through_a_gate", "horizon.duration=3", "leave out [horizon]");
  refused("through_a_gate", "phase.1.through.x=1", "the last phase ends where [boundary] says");
  refused("through_a_gate", "phase.0.through.z=1", "unknown");
  refused("through_a_gate", "phase.1.name=\"to the gate\"", "the name of another phase");
  refused("through_a_gate", "phase.0.name=\"a\\nexit\"", "control character");
  refused("through_a_gate", "phase.0.bounds.curvature=[1.0, -1.0]", "1 is not below -1");
  refused("through_a_gate", "phase.0.duration=0", "positive");
  refused("through_a_gate", "phase.0.range=[4.0, 5.0]", "is not between 4 and 5");
  refused("through_a_gate", "phase.0.parameters.speed=2", "unknown");
  refused("through_a_gate", "boundary.end_on=[\"x + z\"]", "boundary.end_on");
  refused("through_a_gate", "boundary.free_end=[\"heading\"]", "is no number of the state; they are x, y, angle");
  refused("through_a_gate", "boundary.free_end=[]", "name in free_end what may differ from the end");
  refused("through_a_gate", "loop.samples=3", "looks ahead in one phase");
  refused("control_loop", "boundary.free_end=[\"w1\"]", "leave out boundary.free_start");
  refused("keep_out", "boundary.free_end=[\"r1\"]", "an attitude is given by all three of its numbers");
}

TEST_F(Control, ScenesOfBodiesSayWhatIsWrongWithThem) {
  const auto refused = [&](const std::string& set, const std::string& words) {
    const Outcome r = run(scene("arm_of_bodies") + " --set '" + set + "'");
    EXPECT_EQ(r.code, 2) << set << r.err;
    EXPECT_NE(r.err.find(words), std::string::npos) << set << ": " << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  };
  refused("actuator.0.effect=\"engine\"", "there is no effect \"engine\" to be controlled; names are shoulder, elbow");
  refused("actuator.0.bounds=[1.0, -1.0]", "1 is not below -1");
  refused("actuator.0.bound=[-1.0, 1.0]", "unknown");
  refused("end.0.body=\"hand\"", "there is no body \"hand\"; there are upper, fore");
  refused("end.0.attitude=[0.0, 0.0, 1.0]", "does not turn in space: give its angle");
  refused("end.0.position=[0.0, 0.0, 1.0]", "give 2 numbers of this body");
  refused("end.0.position=[5.0, 0.0]", "do not reach the end");
  refused("end.0.velocity=[0.0, 0.0]", "leave it out of a body at_rest");
  refused("end.0.at=[0.1, 0.0, 0.0]", "give position, or leave it out");
  refused("constraint.0.centre=[1.0, 0.0, 0.0]", "is inside at the start");
  refused("constraint.0.kind=\"tube\"", "sphere");
  refused("horizon.free=true", "give it a weight");
  refused("effect.0.rate=1.0", "follow time");
}

TEST_F(Control, LimitsOfBodiesSayWhatIsWrongWithThem) {
  const auto refused = [&](const std::string& name, const std::string& limit, const std::string& words) {
    const Outcome r = run("control " + write(text_of(name) + "\n[[constraint]]\n" + limit).string());
    EXPECT_EQ(r.code, 2) << limit << r.err;
    EXPECT_NE(r.err.find(words), std::string::npos) << limit << ": " << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  };
  const std::string cone = "kind = 'cone'\nbody = 'front'\ndirection = [0, 0, 1]\naxis = [0, 0, 2]\n";
  refused("cat_of_bodies", cone, "give at_least or at_most");
  refused("cat_of_bodies", cone + "at_least = 0.3\n", "has its direction 0 rad from the axis at the start");
  refused("cat_of_bodies", cone + "at_most = 3.2\n", "between 0 and pi");
  refused("cat_of_bodies", cone + "at_most = 0\n", "between 0 and pi");
  refused("cat_of_bodies", cone + "at_least = 2\nat_most = 1\n", "2 is not below at_most, 1");
  refused("cat_of_bodies", "kind = 'cone'\nbody = 'front'\ndirection = [0, 0, 0]\naxis = [0, 0, 1]\nat_most = 1\n",
          "must not vanish");
  refused("arm_of_bodies", "kind = 'cone'\nbody = 'fore'\ndirection = [1, 0, 0]\naxis = [1, 0, 0]\nat_most = 1\n",
          "\"fore\" does not turn in space");
  refused("arm_of_bodies", "kind = 'speed'\nbody = 'fore'\n", "give speed (m/s) or angular_speed (rad/s)");
  refused("arm_of_bodies", "kind = 'speed'\nbody = 'fore'\nspeed = 0\n", "positive");
  refused("arm_of_bodies", "kind = 'speed'\nbody = 'fore'\nangular_speed = 1\nat = [1, 0, 0]\n",
          "constraint.4.at: is the point that speed is of: give speed, or leave it out");
  // The wheel turns at the start, or at the end.
  const std::string wheel = "[[body]]\nname = 'wheel'\nkind = 'pivoted'\ninertia = [1, 1, 2]\n";
  const std::string turns = "attitude = [0.8, 0.6, 0, 0]\nangular_velocity = [0, 0, 3]\n";
  const std::string rim = "kind = 'speed'\nbody = 'wheel'\nat = [0, 0.5, 1]\nspeed = 1\n";
  refused("arm_of_bodies", "kind = 'speed'\nbody = 'wheel'\nspeed = 1\n" + wheel,
          "\"wheel\" is held at its pivot: give a point of it by at");
  refused("arm_of_bodies", rim + wheel + turns, "\"wheel\" has 1.5 m/s at the start");
  refused("arm_of_bodies", rim + wheel + "[[end]]\nbody = 'wheel'\n" + turns,
          "\"wheel at (0, 0.5, 1)\" has 1.5 m/s at the end that [[end]] gives");
  const std::string falls = "[[body]]\nname = 'ball'\nkind = 'point'\nmass = 1\nposition = [5, 5, 5]\n";
  refused("arm_of_bodies", "kind = 'speed'\nbody = 'ball'\nangular_speed = 1\n" + falls, "does not turn");
  refused("arm_of_bodies", "kind = 'speed'\nbody = 'ball'\nspeed = 1\n" + falls + "velocity = [2, 0, 0]\n",
          "speed limit of ball does not hold at the start");
}

TEST_F(Control, LimitsOfBodiesAreActiveInWhatIsWritten) {
  const fs::path out = folder_ / "limited";
  const fs::path file = write(text_of("arm_of_bodies") +
                              "\n[[constraint]]\nkind = 'speed'\nbody = 'fore'\nspeed = 1.5\n"
                              "[[constraint]]\nkind = 'speed'\nbody = 'fore'\nat = [0.5, 0, 0]\nspeed = 2\n"
                              "[[effect]]\nkind = 'drag'\nbodies = ['fore']\nmotion = 0.2\nturning = 0.1\n");
  const std::string set = "control " + file.string() + " --json --set horizon.stages=30 --set solver.starts=4";
  const Outcome r = run(set + " --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err;
  const auto found = nlohmann::json::parse(r.out);
  EXPECT_GT(found.at("crossover").at("active"), 0);
  const auto [header, rows] = rows_of(out);
  std::vector<std::string> names;
  std::istringstream cells(header);
  for (std::string name; std::getline(cells, name, ',');) names.push_back(name);
  const auto column = [&](const std::string& name) {
    return std::size_t(std::find(names.begin(), names.end(), name) - names.begin());
  };
  double fastest = 0;
  for (const auto& row : rows)
    fastest = std::max(fastest, std::hypot(row.at(column("fore.vx")), row.at(column("fore.vy"))));
  EXPECT_NEAR(fastest, 1.5, 1e-9);
  std::vector<std::string> active;
  for (const auto& each : found.at("active")) active.push_back(each.at("name").get<std::string>());
  EXPECT_TRUE(std::count(active.begin(), active.end(), "speed limit of fore at (0.5, 0, 0)")) << r.out;
  const Outcome by_ipopt = run(set + " --set solver.method=ipopt");
  if (by_ipopt.code == 2) {
    EXPECT_NE(by_ipopt.err.find("install coinor-libipopt-dev"), std::string::npos) << by_ipopt.err;
    GTEST_SKIP() << "a build without IPOPT";
  }
  ASSERT_EQ(by_ipopt.code, 0) << by_ipopt.err;
  const auto theirs = nlohmann::json::parse(by_ipopt.out);
  EXPECT_EQ(theirs.at("method"), "ipopt");
  EXPECT_NEAR(theirs.at("cost").get<double>(), found.at("cost").get<double>(), 1e-7);
}

TEST_F(Control, IpoptFindsTheSameInTheSameFiles) {
  const std::string set = " --json --set horizon.stages=40 --set solver.starts=2";
  const std::string out = (folder_ / "by_ipopt").string();
  const Outcome r = run(scene("swing_up") + set + " --set solver.method=ipopt --out " + out);
  if (r.code == 2) {
    EXPECT_NE(r.err.find("install coinor-libipopt-dev"), std::string::npos) << r.err;
    GTEST_SKIP() << "a build without IPOPT";
  }
  ASSERT_EQ(r.code, 0) << r.err;
  const auto by_ipopt = nlohmann::json::parse(r.out);
  const auto ours = nlohmann::json::parse(run(scene("swing_up") + set).out);
  EXPECT_NEAR(by_ipopt.at("cost").get<double>(), ours.at("cost").get<double>(), 1e-8);
  EXPECT_EQ(by_ipopt.at("method"), "ipopt");
  EXPECT_EQ(ours.at("method"), "interior_point");
  EXPECT_TRUE(by_ipopt.at("strict_minimum").get<bool>());
  for (const char* name : {"trajectory.csv", "summary.json", "summary.txt"})
    EXPECT_TRUE(fs::exists(fs::path(out) / name)) << name;
  const Outcome failed = run(scene("swing_up") + set + " --set solver.method=ipopt --set solver.iterations=2");
  EXPECT_EQ(failed.code, 3);
  EXPECT_NE(failed.err.find("IPOPT: not converged"), std::string::npos) << failed.err;
  const Outcome loop = run(scene("control_loop") + " --set solver.method=ipopt");
  EXPECT_EQ(loop.code, 2);
  EXPECT_NE(loop.err.find("leave out solver.method"), std::string::npos) << loop.err;
}

TEST_F(Control, WhereEveryMotionCostsTheSameNoneIsAStrictMinimum) {
  const Outcome r = run(scene("fastest_stop") + " --json --set horizon.free=false --set horizon.duration=4");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_FALSE(nlohmann::json::parse(r.out).at("strict_minimum").get<bool>());
}

TEST_F(Control, EndsThatBreakAnInequalityAreRefused) {
  const auto refused = [&](const std::string& name, const std::string& set, const std::string& words) {
    const Outcome r = expect_refused(scene(name) + " --set '" + set + "'", words);
    EXPECT_NE(r.err.find("; give a state where it does"), std::string::npos) << r.err;
  };
  refused("around_a_disk", "boundary.start=[-0.5,0,0,0]", "boundary.start: what parameters.disk_radius asks for");
  refused("around_a_disk", "boundary.end=[0.5,0,0,0]", "boundary.end: what parameters.disk_radius asks for");
  refused("keep_out", "parameters.avoided=[0,0,1]", "boundary.start: what parameters.cone asks for");
  refused("falling_cat", "boundary.end=[0,0,0,1.6,0,0,0,0,0,0]", "boundary.end: what parameters.largest_bend asks for");
  refused("parallel_parking", "boundary.end=[0,1,0,0,0.7]", "boundary.end: what parameters.largest_steering asks for");
  expect_refused(scene("keep_out") + " --set parameters.cone=4", "parameters.cone: must be from 0 to pi");
  // On the rim it holds, and where an end is free is not known.
  const std::string quick = " --set solver.starts=1 --set solver.iterations=2";
  EXPECT_NE(run(scene("around_a_disk") + " --set 'boundary.end=[1,0,0,0]'" + quick).code, 2);
  EXPECT_NE(
      run(scene("around_a_disk") + " --set 'boundary.end=[0.5,0,0,0]' --set 'boundary.free_end=[\"x\"]'" + quick).code,
      2);
}

TEST_F(Control, AnEndOfBodiesInsideOfAnObstacleIsRefused) {
  const std::string mass =
      "control = 'bodies'\n[[body]]\nname = 'mass'\nkind = 'planar'\nmass = 2\ninertia = 1\n"
      "position = [0, 0]\n[[effect]]\nkind = 'force'\nname = 'east'\nbody = 'mass'\n"
      "force = [1, 0, 0]\n[[effect]]\nkind = 'force'\nname = 'north'\nbody = 'mass'\n"
      "force = [0, 1, 0]\n[[actuator]]\neffect = 'east'\n[[actuator]]\neffect = 'north'\n"
      "[horizon]\nduration = 2\nstages = 20\n[solver]\nstarts = 1\n";
  const auto disk = [](const std::string& at) {
    return "[[constraint]]\nkind = 'disk'\nbody = 'mass'\nat = " + at + "\ncentre = [3, 0, 0]\nradius = 0.5\n";
  };
  const auto end = [](const std::string& place) { return "[[end]]\nbody = 'mass'\nat_rest = true\n" + place; };
  const auto scene_of = [&](const std::string& text) { return "control " + write(mass + text).string(); };
  expect_refused(scene_of(end("position = [3, 0]\n") + disk("[0, 0, 0]")), "inside at the end that [[end]] gives");
  // A point beside the one that is given: where it ends is known with the angle alone.
  const std::string beside = disk("[1, 0, 0]");
  expect_refused(scene_of(end("position = [2, 0]\nangle = 0\n") + beside), "inside at the end that [[end]] gives");
  EXPECT_EQ(run(scene_of(end("position = [2, 0]\nangle = 3\n") + beside)).code, 3);  // no torque turns it
  EXPECT_EQ(run(scene_of(end("position = [3, 1]\n") + disk("[0, 0, 0]"))).code, 0);
  // The end is found at any distance: of an effort of 12 d^2 m^2 / T^3.
  for (const double d : {3.0, 1e3, 1e5}) {
    const Outcome far = run(scene_of(end("position = [" + std::to_string(d) + ", 0]\n")) + " --json");
    ASSERT_EQ(far.code, 0) << d << far.err;
    EXPECT_NEAR(nlohmann::json::parse(far.out).at("cost").get<double>() / (6 * d * d), 1, 1e-2) << d;
  }
}

TEST_F(Control, ALoopOfWhatConservesItsEndIsRefused) {
  expect_refused(scene("falling_cat") + " --set loop.samples=3 --set solver.starts=1",
                 "a loop is between states that are given, and M1 is conserved");
}

TEST_F(Control, ItsFolderIsNoRun) {
  const std::string out = (folder_ / "found").string();
  ASSERT_EQ(run(scene("fastest_stop") + " --out " + out).code, 0);
  for (const char* command : {"plot ", "resume "})
    expect_refused(command + out, "holds what lagroid control found, and no run; its picture is " + out + "/plot.svg");
}

TEST_F(Control, ABoundThatIsInfiniteIsToldWhatToWrite) {
  for (const char* bounds : {"bounds.u=[-1,inf]", "bounds.u={min=-inf}"})
    expect_refused(scene("fastest_stop") + " --set '" + bounds + "'", "inf; for no bound leave it out: { min = ... }");
  for (const char* other : {"horizon.duration=inf", "boundary.end=[1,inf]"}) {
    const Outcome r = expect_refused(scene("fastest_stop") + " --set '" + other + "'", "must be finite, got inf");
    EXPECT_EQ(r.err.find("bound leave"), std::string::npos) << r.err;
  }
}

TEST_F(Control, MistakesAreOneLine) {
  const auto refused = [&](const std::string& set, const std::string& words) {
    const Outcome r = run(scene("fastest_stop") + " --set " + set);
    EXPECT_EQ(r.code, 2) << set << r.err;
    EXPECT_NE(r.err.find(words), std::string::npos) << set << ": " << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  };
  refused("bounds.u=[1,-1]", "1 is not below -1");
  refused("bounds.v=[0,1]", "unknown");
  refused("boundary.end=[0]", "x, v");
  refused("horizon.duration=-1", "positive");
  refused("horizon.stages=1", "2");
  refused("control=dubins", "dubins_car");
  refused("loop.samples=3", "leave out horizon.free");
  const Outcome none = run(scene("control_loop") + " --set loop.samples=0");
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("loop.samples"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace app_control_command_tests
