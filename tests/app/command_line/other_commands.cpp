// Commands that run no scene: reproduce, view, plot, list.
#include "../command_line.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <string>

namespace command_line_other_commands_tests {
namespace {

TEST_F(CommandLine, AnUnknownCommandIsNamed) {
  const Outcome r = run("frobnicate");
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("frobnicate"), std::string::npos) << r.err;
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
}

TEST_F(CommandLine, ReproducesNewtonOnLieGroups) {
  const fs::path out = folder_ / "newton";
  const Outcome r =
      run("reproduce newton-on-lie-groups --largest 4 --seeds 2 --first-seed 40 --json --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err;
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_EQ(json.at("steps"), 2 * 3 * 2 * 21);
  for (const char* example : {"example 1", "example 2"}) {
    const auto& solved = json.at("solved").at(example);
    EXPECT_EQ(solved.at("Newton and path"), 1.0);
    EXPECT_LT(solved.at("fixed point"), 0.7);
    EXPECT_GT(solved.at("version 1"), solved.at("version 2"));
  }
  std::ifstream csv(out / "cells.csv");
  std::string line;
  int lines = 0;
  while (std::getline(csv, line)) ++lines;
  EXPECT_EQ(lines, 1 + 7 * 2 * 3 * 2 * 21);
  for (const char* file : {"report.md", "tables.md", "figure_5_1.svg", "figure_5_2.svg", "solved.svg", "time.svg"})
    EXPECT_TRUE(fs::exists(out / file)) << file;
}

TEST_F(CommandLine, ComparesTimeSteps) {
  const fs::path out = folder_ / "time";
  const Outcome r = run("reproduce time-steps --refinements 3 --json --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err;
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_EQ(json.at("runs"), 2 * 8 * 3);
  // Smaller errors than equal steps at equal cost on an orbit with e = 0.9.
  EXPECT_GE(json.at("gain_at_equal_cost").at("kepler").at("controlled"), 5.0);
  for (const char* file : {"report.md", "runs.csv", "steps.csv", "cost_kepler.svg", "steps_pendulum.svg"})
    EXPECT_TRUE(fs::exists(out / file)) << file;
}

TEST_F(CommandLine, ReproduceRefusesWhatItCannotDo) {
  EXPECT_EQ(run("reproduce").code, 2);
  EXPECT_EQ(run("reproduce some-other-paper").code, 2);
  EXPECT_EQ(run("reproduce newton-on-lie-groups --largest 1").code, 2);
  EXPECT_EQ(run("reproduce time-steps --refinements 1").code, 2);
  EXPECT_EQ(run("reproduce time-steps --out /proc/here").code, 2);
  const Outcome crossed = run("reproduce newton-on-lie-groups --smallest 5 --largest 4 --json");
  EXPECT_EQ(crossed.code, 2);
  EXPECT_EQ(nlohmann::json::parse(crossed.out).at("status"), "invalid_command_line");
  EXPECT_EQ(run("reproduce newton-on-lie-groups --out /proc/here").code, 2);
  EXPECT_EQ(entries(), 1U) << "nothing but the file of standard error";
}

TEST_F(CommandLine, ViewWritesOnePageWithWhatTheRunRecorded) {
  const fs::path out = folder_ / "run";
  ASSERT_EQ(run("run " + example("kepler") + " --set time.steps=50 --out " + out.string()).code, 0);
  const Outcome r = run("view " + out.string());
  EXPECT_EQ(r.code, 0) << r.err;
  std::ifstream file(out / "view.html");
  const std::string page(std::istreambuf_iterator<char>(file), {});
  EXPECT_EQ(page.find("src="), std::string::npos) << "the page needs nothing else";
  const std::string opening = "id=\"run\">";
  const std::size_t from = page.find(opening) + opening.size();
  const auto data = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  EXPECT_EQ(data.at("time").size(), 51U);
  EXPECT_EQ(data.at("columns").at("x").size(), 51U);
  EXPECT_EQ(data.at("columns").at("x").at(0), 0.4);
  EXPECT_EQ(data.at("shapes").size(), 2U);
  const auto of = [&](const std::string& rows) {
    run("view --rows " + rows + " " + out.string());
    std::ifstream again(out / "view.html");
    const std::string text(std::istreambuf_iterator<char>(again), {});
    return nlohmann::json::parse(text.substr(from, text.find("</script>", from) - from));
  };
  EXPECT_EQ(of("10").at("time").back(), data.at("time").back()) << "the last row is kept";
  EXPECT_LE(of("10").at("time").size(), 11U);
}

TEST_F(CommandLine, PlotDrawsAnewWhatWasEdited) {
  const fs::path out = folder_ / "run";
  ASSERT_EQ(run("run " + example("kepler") + " --set time.steps=50 --out " + out.string()).code, 0);
  fs::remove(out / "plot.svg");
  EXPECT_EQ(run("plot " + out.string()).code, 0);
  EXPECT_TRUE(fs::exists(out / "plot.svg"));
  std::ofstream(out / "plot.gp", std::ios::app) << "set output 'plot.svg'\nnonsense\n";
  const Outcome r = run("plot --own-script " + out.string());
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("gnuplot failed"), std::string::npos) << r.err;
  EXPECT_TRUE(fs::exists(out / "plot.svg")) << "the picture there is stays";
}

TEST_F(CommandLine, WhatIsNoRunIsRefusedWithTheRemedy) {
  for (const std::string command : {"view ", "plot "}) {
    const Outcome nowhere = run(command + (folder_ / "nowhere").string());
    EXPECT_EQ(nowhere.code, 2);
    EXPECT_NE(nowhere.err.find("no such folder; lagroid run SCENE --out"), std::string::npos) << nowhere.err;
    fs::create_directories(folder_ / "empty");
    EXPECT_EQ(run(command + (folder_ / "empty").string()).code, 2);
    EXPECT_TRUE(fs::is_empty(folder_ / "empty"));
  }
  const fs::path out = folder_ / "run";
  ASSERT_EQ(run("run " + example("kepler") + " --set time.steps=50 --out " + out.string()).code, 0);
  EXPECT_EQ(run("view --rows 1 " + out.string()).code, 2);
  std::ofstream(out / "trajectory.h5") << "no HDF5";
  const Outcome broken = run("view " + out.string());
  EXPECT_EQ(broken.code, 2);
  EXPECT_NE(broken.err.find("trajectory.h5"), std::string::npos) << broken.err;
  std::ofstream(out / "summary.json") << "{";
  EXPECT_NE(run("view " + out.string()).err.find("summary.json"), std::string::npos);
}

TEST_F(CommandLine, OneCommandAtATime) {
  EXPECT_EQ(run("run " + example("pendulum") + " list").code, 2);
  EXPECT_EQ(run("--help >/dev/full").code, 3);
}

TEST_F(CommandLine, ListNamesSystemsGroupoidsParametersAndSymmetries) {
  const auto listed = nlohmann::json::parse(run("list --json").out);
  const std::string text = run("list").out;
  for (const auto& system : listed) {
    for (const char* key : {"name", "groupoid", "summary"})
      EXPECT_NE(text.find(system.at(key).get<std::string>()), std::string::npos) << system;
    for (const auto& parameter : system.at("parameters"))
      EXPECT_NE(text.find(parameter.at("name").get<std::string>()), std::string::npos) << parameter;
  }
  EXPECT_EQ(listed.at(0).at("symmetries").size(), 3U);
}

TEST_F(CommandLine, ListOfOneSystem) {
  const std::string all = run("list").out, one = run("list damped_pendulum").out;
  EXPECT_TRUE(one.starts_with("damped_pendulum ")) << one;
  EXPECT_NE(all.find(one), std::string::npos);
  EXPECT_LT(one.size(), all.size() / 4);
  EXPECT_EQ(nlohmann::json::parse(run("list kepler --json").out).size(), 1U);
  const Outcome r = run("list damped_pendulums");
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("did you mean \"damped_pendulum\"?"), std::string::npos) << r.err;
}

TEST_F(CommandLine, EveryListedParameterIsRead) {
  // A table in the place of a parameter is refused under its name; an unlisted key is refused as unknown.
  for (const auto& system : nlohmann::json::parse(run("list --json").out)) {
    const std::string scene = "run " + example(system.at("name")) + " --set parameters.";
    for (const auto& parameter : system.at("parameters")) {
      const std::string key = parameter.at("name");
      const Outcome r = run(scene + key + "={}");
      EXPECT_EQ(r.code, 2) << key;
      EXPECT_NE(r.err.find("parameters." + key), std::string::npos) << r.err;
      EXPECT_EQ(r.err.find("unknown"), std::string::npos) << r.err;
    }
  }
}

TEST_F(CommandLine, ListAndVersion) {
  EXPECT_NE(run("list").out.find("plate_ball"), std::string::npos);
  EXPECT_EQ(run("--version").code, 0);
  EXPECT_EQ(run("--help").code, 0);
}

}  // namespace
}  // namespace command_line_other_commands_tests
