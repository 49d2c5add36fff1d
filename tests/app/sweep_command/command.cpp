// What `lagroid sweep` prints, refuses and costs.
#include "sweep.hpp"

#include <lagroid/app/experiments/sweep_scaling.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace lagroid::sweep_tests::command_tests {
namespace {

TEST_F(Sweep, EveryExampleRuns) {
  const auto small = [&](const std::string& name, const std::string& more, long count) {
    SCOPED_TRACE(name);
    const Outcome r = sweep(example("sweeps/" + name), name, "--json " + more);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(nlohmann::json::parse(r.out).at("members"), count);
  };
  small("basins", "--set vary.0.count=6 --set vary.1.count=5", 30);
  small("rigid_bodies", "--set design.count=50", 50);
  small("kepler", "--set design.count=10 --set scene.time.steps=500", 10);
  small("plate_ball", "--set vary.0.count=2 --set vary.1.count=2", 4);
  small("three_bodies", "--set scene.time.steps=1000", 4);
  EXPECT_EQ(std::count_if(fs::directory_iterator(fs::path(LAGROID_EXAMPLES) / "sweeps"), fs::directory_iterator(),
                          [](const auto& entry) { return entry.path().extension() == ".toml"; }),
            5)
      << "ask the new one, too";
  // Every angle has come to rest near one of the wells.
  for (const double q : column("basins", "final/q")) EXPECT_LT(std::abs(std::remainder(q, 2 * M_PI)), 0.6);
}

TEST_F(Sweep, WhatItCostsIsMeasuredAndModelled) {
  if (const std::string why = without_ranks(); !why.empty()) GTEST_SKIP() << why;
  const Outcome r = run("reproduce sweep-scaling --json --out " + out("scaling"), mpirun(2));
  ASSERT_EQ(r.code, 0) << r.err;
  for (const auto& [name, seconds] : nlohmann::json::parse(r.out).at("seconds").items()) {
    EXPECT_GE(seconds.get<double>(), 0) << name;
    EXPECT_LT(seconds.get<double>(), 10) << name;
  }
  EXPECT_NE(bytes(out("scaling") + "/report.md").find("| 10000 |"), std::string::npos);
  EXPECT_EQ(run("reproduce sweep-scaling --out " + out("alone")).code, 2);
}

TEST(SweepModel, LosesWhatItSays) {
  using lagroid::app::sweep_efficiency;
  using lagroid::app::sweep_seconds;
  lagroid::app::SweepCosts free;
  // The last part alone is lost where nothing costs anything.
  EXPECT_DOUBLE_EQ(sweep_efficiency(free, {.workers = 100, .work = 600, .parts = 9, .member = 1}), 0.9);
  // Rank 0 is the bottleneck where parts are shorter than it takes to hand one to every thread.
  lagroid::app::SweepCosts handing;
  handing.hand = 1e-3;
  EXPECT_DOUBLE_EQ(sweep_seconds(handing, {.workers = 10000, .work = 100, .parts = 100, .member = 1}), 1000 + 1);
  EXPECT_DOUBLE_EQ(sweep_seconds(handing, {.workers = 100, .work = 100, .parts = 100, .member = 1}), 100 + 1);
}

TEST_F(Sweep, TellsOneJsonObject) {
  const Outcome r = sweep(orbits(square), "json", "--json");
  ASSERT_EQ(r.code, 0);
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_EQ(json.at("status"), "converged");
  EXPECT_EQ(json.at("members"), 6);
  EXPECT_EQ(json.at("design").at("keys")[1], "parameters.strength");
  EXPECT_EQ(json.at("columns").at("run/steps").at("mean"), 50);
  EXPECT_EQ(json.at("files").size(), 7U);
}

TEST_F(Sweep, BadInputIsOneLineThatNamesTheRemedy) {
  const std::string good = orbits(square);
  file("nan.csv", "initial.momentum.1\n1\nnan\n");
  file("word.csv", "initial.momentum.1\none\n");
  file("ragged.csv", "initial.momentum.1,parameters.strength\n1,2\n3\n");
  file("twice.csv", "initial.momentum.1,initial.momentum.1\n1,2\n");
  file("stranger.csv", "initial.momentum.7\n1\n");
  file("overlap.csv", "initial.position,initial.position.0\n1,2\n");
  file("empty.csv", "initial.momentum.1\n");
  file("no.h5", "no HDF5");
  file("plain", "");
  const std::string list = orbits("[design]\nkind = \"list\"\n");
  const std::string listed = file("listed.toml", bytes(list));
  orbits(square);
  const std::string pendula = file(
      "pendula.toml", "scene = \"" + example("pendulum") + "\"\n[design]\nkind = \"list\"\nfile = \"overlap.csv\"\n");
  const auto from = [&](const std::string& name) { return listed + " --set design.file=" + name; };
  const std::string there = " --out " + out("bad");
  const std::vector<std::pair<std::string, std::string>> cases{
      {"nowhere.toml" + there, "nowhere.toml"},
      {good + there + " --set design.kind=cube", "latin-hypercube"},
      {good + there + " --set design.kind=random", "missing key \"count\""},
      {good + there + " --set design.count=3", "unknown key"},
      {good + there + " --set vary.0.key=initial.momentum.2", "no number of the scene"},
      {good + there + " --set vary.0.key=initial.momentum", "vary one of them"},
      {good + there + " --set vary.0.key=parameters.strength", "varies already"},
      {good + there + " --set vary.0.key=system", "no number of the scene"},
      {good + there + " --set vary.0.from=inf", "finite"},
      {good + there + " --set vary.0.scale=log --set vary.0.from=0", "positive"},
      {good + there + " --set vary.0.count=0", "from 1 to"},
      {good + there + " --set vary.0.count=99999999 --set vary.1.values=[1,2]", "more than 100000000 members"},
      {good + there + " --set vary.0.cuont=3", "did you mean \"count\""},
      {good + there + " --set vary.1.values=[]", "none"},
      {good + there + " --set vary=[]", "no [[vary]]"},
      {good + there + " --set scene.file=nowhere.toml", "no such scene file"},
      {good + there + " --set scene.time.stpes=3", "orbits.toml: scene.time.stpes"},
      {good + there + " --set keep.final=[\\\"z\\\"]", "these are: position, x, y"},
      {good + there + " --set keep.every=3", "goes with series"},
      {good + there + " --set plot.quantity=z", "no column \"z\""},
      {good + there + " --set run.part=0", "from 1 to"},
      {good + there + " --set run.engine=lanes", "keep.ledger = false"},
      {good + there + " --set run.engine=lanes --set keep.ledger=false", "parameters.strength varies"},
      {good + there + " --set sceen=1", "did you mean \"scene\""},
      {good, "--out"},
      {good + there + " --threads 0", "--threads"},
      {good + " --out /proc/nowhere", "choose another place"},
      {good + " --out " + out("plain"), "is not a folder"},
      {from("nan.csv") + there, "line 3, column initial.momentum.1: nan is not finite"},
      {from("word.csv") + there, "\"one\" is no number"},
      {from("ragged.csv") + there, "line 3 has 1 fields"},
      {from("twice.csv") + there, "two columns"},
      {from("stranger.csv") + there, "design.file: \"initial.momentum.7\" is no number of the scene"},
      {pendula + there, "varies already"},
      {from("empty.csv") + there, "holds no members"},
      {from("no.h5") + there, "HDF5"},
      {from("nowhere.csv") + there, "there is no such file"}};
  for (const auto& [arguments, words] : cases) {
    expect_refused("sweep " + arguments, words);
    EXPECT_FALSE(fs::exists(out("bad"))) << arguments;
  }
}

TEST_F(Sweep, AFullDiskIsOneLineAndThePartsBeforeItStay) {
  const std::string file =
      orbits(random_design("random", 40, "[[vary]]\nkey = \"initial.momentum.1\"\nfrom = 1\nto = 2\n"), 5);
  // Files of at most one block: no sum of parts is written, but each part is.
  const Outcome r = run("sweep " + file + " --out " + out("full"), "trap '' XFSZ; ulimit -f 8; ");
  EXPECT_EQ(r.code, 3) << r.out << r.err;
  EXPECT_NE(r.err.find("is the disk full?"), std::string::npos) << r.err;
  EXPECT_EQ(parts("full"), 40U);
  EXPECT_EQ(sweep(file, "full").code, 0);
  ASSERT_EQ(sweep(file, "whole").code, 0);
  expect_same("whole", "full");
}

}  // namespace
}  // namespace lagroid::sweep_tests::command_tests
