// `lagroid control`: every example, files, refusals, endings.
#include "command_line.hpp"

#include <nlohmann/json.hpp>

#include <sstream>
#include <string>
#include <vector>

namespace {

class Control : public CommandLine {
 protected:
  static std::string scene(const std::string& name) { return "control " + example("control/" + name); }
};

TEST_F(Control, EveryExampleFindsAMinimum) {
  int examples = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(LAGROID_EXAMPLES) / "control")) {
    if (entry.path().extension() != ".toml") continue;
    ++examples;
    const std::string name = entry.path().stem();
    const Outcome r = run(scene(name) + " --json --set horizon.stages=40");
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
  EXPECT_EQ(header, "time,x,v,u,costate_1,costate_2");
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

TEST_F(Control, WhatCannotBeIsTypedAndNamed) {
  const Outcome r =
      run(scene("fastest_stop") + " --json --set horizon.free=false --set horizon.duration=1 --set solver.starts=1");
  EXPECT_EQ(r.code, 3);
  const auto found = nlohmann::json::parse(r.out);
  EXPECT_EQ(found.at("status"), "infeasible");
  EXPECT_FALSE(found.at("violated").empty());
  EXPECT_NE(r.err.find("relax the constraints"), std::string::npos) << r.err;
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
