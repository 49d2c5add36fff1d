// The members of a sweep: grids, random designs, lists.
#include "sweep.hpp"

#include <H5Cpp.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <set>
#include <sstream>
#include <vector>

namespace lagroid::sweep_tests::designs_tests {
namespace {

TEST_F(Sweep, AGridIsInOrderAndItsMembersAreRuns) {
  const std::string file = orbits(square);
  const Outcome r = sweep(file, "grid");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(column("grid", "initial.momentum.1"), (std::vector<double>{1.5, 1.5, 1.75, 1.75, 2.0, 2.0}));
  EXPECT_EQ(column("grid", "parameters.strength"), (std::vector<double>{0.9, 1.1, 0.9, 1.1, 0.9, 1.1}));
  const auto alone = nlohmann::json::parse(
      run("run " + example("kepler") +
          " --set time.steps=50 --set initial.momentum.1=1.75 --set parameters.strength=1.1 --json")
          .out);
  EXPECT_EQ(column("grid", "final/x")[3], alone.at("final").at("position")[0].get<double>());
  EXPECT_EQ(column("grid", "final/py")[3], alone.at("final").at("momentum")[1].get<double>());
  EXPECT_EQ(column("grid", "run/iterations")[3], alone.at("iterations").get<double>());
  EXPECT_EQ(column("grid", "ledger/energy")[3], alone.at("ledger").at("entries")[0].at("drift").get<double>());
  for (const char* name : {"sweep.h5", "summary.json", "summary.txt", "plot.gp", "plot.svg", "plot.png"})
    EXPECT_TRUE(fs::exists(out("grid") + "/" + name)) << name;
  EXPECT_FALSE(fs::exists(out("grid") + "/parts"));
}

TEST_F(Sweep, LogarithmicScalesMeetBothEnds) {
  ASSERT_EQ(sweep(orbits("[design]\nkind = \"grid\"\n[[vary]]\nkey = \"parameters.strength\"\nfrom = 0.1\nto = 10\n"
                         "count = 3\nscale = \"log\"\n"),
                  "log")
                .code,
            0);
  const auto values = column("log", "parameters.strength");
  EXPECT_EQ(values[0], 0.1);
  EXPECT_NEAR(values[1], 1, 1e-15);
  EXPECT_EQ(values[2], 10);
  // Between them whole numbers are met, too: 1000^(1/3) is 10 but for a round-off.
  ASSERT_EQ(sweep(orbits("[design]\nkind = \"grid\"\n[[vary]]\nkey = \"time.steps\"\nfrom = 1\nto = 1000\n"
                         "count = 4\nscale = \"log\"\n"),
                  "steps")
                .code,
            0);
  EXPECT_EQ(column("steps", "run/steps"), (std::vector<double>{1, 10, 100, 1000}));
}

TEST_F(Sweep, WhatElseStandsInTheFolderStays) {
  fs::create_directories(out("mine") + "/parts");
  file("mine/notes.txt", "mine");
  file("mine/parts/notes.txt", "mine");
  ASSERT_EQ(sweep(orbits(square), "mine").code, 0);
  EXPECT_EQ(bytes(out("mine") + "/notes.txt"), "mine");
  EXPECT_EQ(bytes(out("mine") + "/parts/notes.txt"), "mine");
  EXPECT_EQ(parts("mine"), 0U);
  // Results that were taken away are made again.
  fs::remove(out("mine") + "/summary.json");
  ASSERT_EQ(sweep(orbits(square), "mine").code, 0);
  EXPECT_TRUE(fs::exists(out("mine") + "/summary.json"));
}

TEST_F(Sweep, ALatinHypercubeMeetsEveryStratumOnce) {
  const std::string vary = R"(
[[vary]]
key = "initial.momentum.1"
from = 1.0
to = 2.0
[[vary]]
key = "parameters.strength"
mean = 1
deviation = 0.1
[[vary]]
key = "initial.momentum.0"
from = -0.5
to = 0.5
)";
  ASSERT_EQ(sweep(orbits(random_design("latin-hypercube", 40, vary), 2), "lhs").code, 0);
  std::set<int> uniform;
  std::set<int> normal;
  for (const double x : column("lhs", "initial.momentum.1")) uniform.insert(int(40 * (x - 1)));
  for (const double x : column("lhs", "parameters.strength"))
    normal.insert(int(40 * 0.5 * std::erfc(-(x - 1) / 0.1 / std::sqrt(2.0))));
  EXPECT_EQ(uniform.size(), 40U);
  EXPECT_EQ(normal.size(), 40U);
  EXPECT_EQ(*uniform.begin(), 0);
  EXPECT_EQ(*normal.rbegin(), 39);
  // Random members do not, and the keys of a hypercube are paired at random.
  ASSERT_EQ(sweep(orbits(random_design("random", 40, vary), 2), "random").code, 0);
  std::set<int> strata;
  for (const double x : column("random", "initial.momentum.1")) strata.insert(int(40 * (x - 1)));
  EXPECT_LT(strata.size(), 36U);
  const auto a = column("lhs", "initial.momentum.1");
  const auto b = column("lhs", "initial.momentum.0");
  double product = 0;
  for (std::size_t i = 0; i < a.size(); ++i) product += (a[i] - 1.5) * b[i];
  EXPECT_LT(std::abs(product / 40 * 12), 0.5);  // the correlation
}

TEST_F(Sweep, SeedsDecideAndNothingElseDoes) {
  const std::string file =
      orbits(random_design("random", 10, "[[vary]]\nkey = \"initial.momentum.1\"\nfrom = 1\nto = 2\n"), 2);
  ASSERT_EQ(sweep(file, "a").code, 0);
  ASSERT_EQ(sweep(file, "b").code, 0);
  ASSERT_EQ(sweep(file, "c", "--set design.seed=8").code, 0);
  expect_same("a", "b");
  EXPECT_NE(column("a", "initial.momentum.1"), column("c", "initial.momentum.1"));
}

TEST_F(Sweep, SpheresAndAttitudesAreUniform) {
  const std::string file = this->file("tops.toml", "[scene]\nfile = \"" + example("rigid_body") +
                                                       "\"\ntime.steps = 1\n" + random_design("random", 3000, R"(
[[vary]]
key = "initial.momentum"
distribution = "sphere"
radius = 2
[[vary]]
key = "initial.attitude"
distribution = "attitude"
)"));
  ASSERT_EQ(sweep(file, "tops", "--set keep.ledger=false --set run.part=500").code, 0);
  std::array<std::vector<double>, 3> m;
  std::array<std::vector<double>, 4> q;
  for (int i = 0; i < 3; ++i) m[std::size_t(i)] = column("tops", "initial.momentum." + std::to_string(i));
  for (int i = 0; i < 4; ++i) q[std::size_t(i)] = column("tops", "initial.attitude." + std::to_string(i));
  // Each coordinate of a point of S^2 is uniform, and so are the turns of S^3's points: moments with five sigmas.
  for (int i = 0; i < 3; ++i) {
    double first = 0, second = 0, fourth = 0;
    for (std::size_t k = 0; k < 3000; ++k) {
      const double x = m[std::size_t(i)][k] / 2;
      first += x / 3000;
      second += x * x / 3000;
      fourth += x * x * x * x / 3000;
    }
    EXPECT_NEAR(first, 0, 5 * std::sqrt(1 / 3.0 / 3000));
    EXPECT_NEAR(second, 1 / 3.0, 5 * std::sqrt((1 / 5.0 - 1 / 9.0) / 3000));
    EXPECT_NEAR(fourth, 1 / 5.0, 5 * std::sqrt((1 / 9.0 - 1 / 25.0) / 3000));
  }
  for (int i = 0; i < 4; ++i) {
    double second = 0, fourth = 0;
    for (std::size_t k = 0; k < 3000; ++k) {
      const double x = q[std::size_t(i)][k];
      second += x * x / 3000;
      fourth += x * x * x * x / 3000;
    }
    EXPECT_NEAR(second, 1 / 4.0, 5 * std::sqrt((1 / 8.0 - 1 / 16.0) / 3000));
    EXPECT_NEAR(fourth, 1 / 8.0, 5 * std::sqrt(7 / 128.0 / 3000));
  }
  for (std::size_t k = 0; k < 3000; ++k) {
    double norm = 0;
    for (const auto& each : q) norm += each[k] * each[k];
    EXPECT_NEAR(norm, 1, 1e-14);
    EXPECT_NEAR(std::hypot(m[0][k], m[1][k], m[2][k]), 2, 1e-14);
  }
}

TEST_F(Sweep, ListsComeFromCsvAndHdf5) {
  file("list.csv", "# two orbits\ninitial.momentum.1, parameters.strength\n1.9,1\n\n+2.0,1.05\n");
  const double momentum[2] = {1.9, 2.0};
  const double strength[2] = {1, 1.05};
  const hsize_t size = 2;
  {
    const H5::H5File h5(out("list.h5"), H5F_ACC_TRUNC);
    const H5::DataSpace space(1, &size);
    h5.createDataSet("initial.momentum.1", H5::PredType::NATIVE_DOUBLE, space)
        .write(momentum, H5::PredType::NATIVE_DOUBLE);
    h5.createDataSet("parameters.strength", H5::PredType::NATIVE_DOUBLE, space)
        .write(strength, H5::PredType::NATIVE_DOUBLE);
  }
  const std::string design = "[design]\nkind = \"list\"\nfile = \"list.csv\"\n";
  ASSERT_EQ(sweep(orbits(design), "csv").code, 0);
  ASSERT_EQ(sweep(orbits(design), "h5", "--set design.file=list.h5").code, 0);
  EXPECT_EQ(column("csv", "parameters.strength"), (std::vector<double>{1, 1.05}));
  EXPECT_EQ(column("csv", "final/x"), column("h5", "final/x"));
  // Keys of members.csv are a list for another sweep.
  std::string keys;
  std::istringstream lines(bytes(out("csv") + "/members.csv"));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::vector<std::string> words;
    for (std::string word; std::getline(fields, word, ',');) words.push_back(word);
    keys += words[2] + "," + words[3] + "\n";
  }
  this->file("keys.csv", keys);
  ASSERT_EQ(sweep(orbits(design), "again", "--set design.file=keys.csv").code, 0);
  EXPECT_TRUE(bytes(out("csv") + "/members.csv") == bytes(out("again") + "/members.csv"));
}

}  // namespace
}  // namespace lagroid::sweep_tests::designs_tests
