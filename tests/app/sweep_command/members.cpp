// What members of a sweep leave, alone and in lanes.
#include "sweep.hpp"

#include <H5Cpp.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <set>
#include <tuple>
#include <vector>

namespace lagroid::sweep_tests::members_tests {
namespace {

TEST_F(Sweep, SeriesHoldTheNodesThatWereAskedFor) {
  const std::string sorted = this->file("series.toml",
                                        "keep = {series = [\"position\", \"px\"], every = 20, initial = "
                                        "[\"py\"], final = [\"px\"], ledger = false}\n" +
                                            bytes(orbits(square)));
  ASSERT_EQ(sweep(sorted, "series").code, 0);
  const H5::H5File h5(out("series") + "/sweep.h5", H5F_ACC_RDONLY);
  const auto read = [&](const std::string& name) {
    const H5::DataSet set = h5.openDataSet(name);
    std::vector<double> values(std::size_t(set.getSpace().getSimpleExtentNpoints()));
    set.read(values.data(), H5::PredType::NATIVE_DOUBLE);
    return values;
  };
  const auto t = read("series/t");
  ASSERT_EQ(t.size(), 6U * 4);
  EXPECT_NEAR(t[1], 0.2, 1e-15);
  EXPECT_NEAR(t[3], 0.5, 1e-15);
  const auto px = read("series/px");
  const auto last = read("final/px");
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(px[4 * i + 3], last[i]);
  EXPECT_EQ(read("initial/py"), read("keys/initial.momentum.1"));
  EXPECT_EQ(members("series").count("final/x"), 0U);
  EXPECT_EQ(members("series").count("ledger/energy"), 0U);
}

TEST_F(Sweep, AMemberThatFailsFailsAlone) {
  const std::string file = orbits(
      "[design]\nkind = \"grid\"\n[[vary]]\nkey = \"initial.position.0\"\n"
      "values = [0.4, 0.0, 0.5]\n");
  const Outcome r = sweep(file, "some");
  EXPECT_EQ(r.code, 3);
  EXPECT_NE(r.err.find("1 of 3 members failed"), std::string::npos) << r.err;
  const auto status = members("some").at("status");
  EXPECT_EQ(status[0], "converged");
  EXPECT_EQ(status[1], "invalid_scene");
  EXPECT_EQ(status[2], "converged");
  EXPECT_TRUE(std::isnan(column("some", "final/x")[1]));
  const auto json = nlohmann::json::parse(bytes(out("some") + "/summary.json"));
  EXPECT_EQ(json.at("status"), "members_failed");
  EXPECT_EQ(json.at("failures")[0].at("member"), 1);
  EXPECT_NE(json.at("failures")[0].at("message").get<std::string>().find("centre of attraction"), std::string::npos);
  // A step that is not solved leaves the state before it.
  const std::string steps = this->file("steps.toml", "[scene]\nfile = \"" + example("rigid_body") +
                                                         "\"\ntime.steps = 50\n[design]\nkind = \"grid\"\n"
                                                         "[[vary]]\nkey = \"initial.momentum.1\"\nvalues = [2, 1e4]\n");
  EXPECT_EQ(sweep(steps, "steps").code, 3);
  EXPECT_EQ(members("steps").at("status"), (std::vector<std::string>{"converged", "stagnated"}));
  EXPECT_EQ(column("steps", "run/steps"), (std::vector<double>{50, 0}));
  EXPECT_EQ(column("steps", "final/t")[1], 0);
  // Told again by the same command, which finds nothing left to do.
  const Outcome again = sweep(file, "some", "--json");
  EXPECT_EQ(again.code, 3);
  EXPECT_EQ(nlohmann::json::parse(again.out).at("failed"), json.at("failed"));
}

TEST_F(Sweep, AnySceneIsAMember) {
  const auto over = [&](const std::string& scene, const std::string& key, const std::string& values,
                        const std::string& more, const std::string& column_of) {
    SCOPED_TRACE(scene);
    const std::string file = this->file("any.toml", "[scene]\nfile = \"" + example(scene) + "\"\n" + more +
                                                        "\n[design]\nkind = \"grid\"\n[[vary]]\nkey = \"" + key +
                                                        "\"\nvalues = " + values + "\n");
    const Outcome r = sweep(file, scene);
    EXPECT_EQ(r.code, 0) << r.err;
    if (r.code != 0) return;
    const auto found = column(scene, column_of);
    EXPECT_TRUE(std::isfinite(found[0]));
    EXPECT_NE(found[0], found[1]);
  };
  over("kepler_boundary", "boundary.end.position.0", "[-0.3, -0.2]", "solver.starts = 4\ntime.steps = 20", "run/cost");
  over("plate_ball", "parameters.spin", "[0.5, 0.6]", "solver.starts = 4\ntime.steps = 10", "run/cost");
  over("pythagorean", "body.1.mass", "[4, 4.1]", "time.steps = 100", "final/t");
  over("pendulum_chain", "time.step", "[0.01, 0.02]", "time.steps = 10", "final/t");
  over("kepler_adaptive", "initial.momentum.1", "[1.9, 2]", "time.steps = 20", "final/t");
}

TEST_F(Sweep, AnAccuracyIsChosenOnceForAllMembers) {
  const std::string file = this->file("accurate.toml", R"(
[scene]
system = "pendulum"
[scene.time]
duration = 5.0
[scene.accuracy]
target = 1e-3
pilot = 0.2
[scene.initial]
position = [1.0]
momentum = [0.0]
[design]
kind = "grid"
[[vary]]
key = "initial.position.0"
from = 0.1
to = 2.5
count = 4
)");
  const Outcome r = sweep(file, "accurate");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("accuracy: for an error of"), std::string::npos) << r.out;
  const auto steps = column("accurate", "run/steps");
  EXPECT_EQ(std::set<double>(steps.begin(), steps.end()).size(), 1U);
}

TEST_F(Sweep, LanesAndScenesAgreeToRoundOff) {
  const std::string ranges = R"(
[[vary]]
key = "initial.momentum.0"
from = 0.2
to = 0.6
[[vary]]
key = "initial.momentum.1"
from = 0.2
to = 0.6
)";
  const std::string range = R"(
[[vary]]
key = "initial.position.0"
from = 0.2
to = 2.6
)";
  for (const auto& [scene, vary, series] : {std::tuple("rigid_body", ranges, "M1"), std::tuple("pendulum", range, "q"),
                                            std::tuple("plate_ball_initial_value", ranges, "px")}) {
    SCOPED_TRACE(scene);
    // A number of members that fills no register.
    const std::string file =
        this->file("lanes.toml", "keep = {ledger = false, every = 30, series = [\"" + std::string(series) +
                                     "\"]}\n[scene]\nfile = \"" + example(scene) + "\"\ntime.steps = 100\n" +
                                     random_design("latin-hypercube", 21, vary));
    const std::string lanes = std::string(scene) + "_lanes";
    const std::string scenes = std::string(scene) + "_scenes";
    const Outcome r = sweep(file, lanes);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("engine    lanes"), std::string::npos) << r.out;
    ASSERT_EQ(sweep(file, scenes, "--set run.engine=scenes").code, 0);
    for (const auto& [name, values] : members(lanes)) {
      if (name == "status" || name == "run/steps") {
        EXPECT_EQ(values, members(scenes).at(name));
      }
      if (!name.starts_with("final/")) continue;
      const auto a = column(lanes, name);
      const auto b = column(scenes, name);
      for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-11 * (1 + std::abs(b[i]))) << name;
    }
    // Threads and parts change nothing in lanes either.
    ASSERT_EQ(sweep(file, lanes + "2", "--threads 1 --set run.part=8 --set run.engine=lanes").code, 0);
    EXPECT_TRUE(bytes(out(lanes) + "/members.csv") == bytes(out(lanes + "2") + "/members.csv"));
  }
}

TEST_F(Sweep, AMemberThatFailsInALaneFailsAlone) {
  const std::string file =
      this->file("steps.toml", "[scene]\nfile = \"" + example("rigid_body") +
                                   "\"\ntime.steps = 50\n[keep]\nledger = false\n[design]\nkind = "
                                   "\"grid\"\n[[vary]]\nkey = \"initial.momentum.1\"\nvalues = [2, 1e4, 3]\n");
  EXPECT_EQ(sweep(file, "lanes", "--set run.engine=lanes --set run.part=3").code, 3);
  EXPECT_EQ(sweep(file, "scenes", "--set run.engine=scenes").code, 3);
  EXPECT_EQ(members("lanes").at("status"), members("scenes").at("status"));
  EXPECT_EQ(column("lanes", "run/steps"), (std::vector<double>{50, 0, 50}));
  EXPECT_NEAR(column("lanes", "final/M2")[2], column("scenes", "final/M2")[2], 1e-12);
}

}  // namespace
}  // namespace lagroid::sweep_tests::members_tests
