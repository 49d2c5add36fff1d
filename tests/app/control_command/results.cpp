// What `lagroid control` leaves: names and units of costates, constraints by their names, the page of `lagroid view`.
#include "control_command.hpp"

#include <reading/csv_table.hpp>
#include <reading/data_set.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <H5Cpp.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace app_control_results_tests {
namespace {

using nlohmann::json;

class ControlResults : public control_command_tests::ControlCommand {
 protected:
  static std::string contents_of(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// The data of the page that `view` makes of a folder.
  json page_of(const fs::path& folder) const {
    const Outcome r = run("view " + folder.string());
    EXPECT_EQ(r.code, 0) << r.err;
    const std::string page = contents_of(folder / "view.html");
    const std::string begin = "<script type=\"application/json\" id=\"run\">";
    const auto at = page.find(begin) + begin.size();
    return json::parse(page.substr(at, page.find("</script>", at) - at));
  }
};

// By differences of the cost: exactly of discrete steps, and of flows to half a stage.
TEST_F(ControlResults, CostatesAreDerivativesOfTheCost) {
  int runs = 0;
  const auto out = [&] { return folder_ / ("run" + std::to_string(runs)); };
  const auto cost = [&](const std::string& name, const std::string& set) {
    ++runs;
    const Outcome r = run(scene(name) + " --set solver.starts=1 --json" + set + " --out " + out().string());
    EXPECT_EQ(r.code, 0) << r.err;
    return json::parse(r.out).at("cost").get<double>();
  };
  const auto by = [&](const std::string& name, const std::string& end) {
    return (cost(name, " --set boundary." + end + ",0.001]") - cost(name, " --set boundary." + end + ",-0.001]")) /
           2e-3;
  };
  const std::string start = "start=[0", end = "end=[3.141592653589793";
  /// Of the first stage, or of the last.
  const auto costate = [&](const std::string& column, bool last) {
    const auto table = lagroid::app::read_csv_table(out() / "trajectory.csv", "time", lagroid::app::Gaps::allowed);
    return table.rows.at(last ? table.rows.size() - 2 : 0).at(table.column(column));
  };
  cost("pendulum", "");
  const double source = costate("pmomentum_source", false), target = costate("pmomentum_target", true);
  EXPECT_NEAR(by("pendulum", start), source, 1e-4);
  EXPECT_NEAR(by("pendulum", end), -target, 1e-4);
  cost("swing_up", "");
  const double first = costate("prate", false), last = costate("prate", true);
  const double half_a_stage = 0.5 * 10 / 200 * std::abs(costate("pangle", false));  // by which prate changes in it
  EXPECT_NEAR(by("swing_up", start), -first, 1.1 * half_a_stage);
  EXPECT_NEAR(by("swing_up", end), last, 1.1 * half_a_stage);
}

// With few stages where there are many: what is drawn is another matter than what is found.
TEST_F(ControlResults, EveryExampleHasAPage) {
  for (const auto& entry : fs::directory_iterator(fs::path(LAGROID_EXAMPLES) / "control")) {
    if (entry.path().extension() != ".toml") continue;
    const std::string name = entry.path().stem();
    const std::string text = text_of(name);
    const fs::path out = folder_ / name;
    const bool has_phases = text.find("[[phase]]") != std::string::npos;
    const std::string fewer = text.find("[loop]") != std::string::npos ? " --set loop.samples=20" : "";
    const Outcome r = run(scene(name) + (has_phases ? "" : " --set horizon.stages=30") + fewer +
                          " --set solver.starts=3 --out " + out.string());
    ASSERT_TRUE(r.code == 0 || r.code == 3) << name << r.err;
    EXPECT_TRUE(json::parse(contents_of(out / "summary.json")).at("repeated").empty()) << name;
    const json page = page_of(out);
    const auto& columns = page.at("columns");
    const std::size_t nodes = page.at("time").size();
    EXPECT_GT(nodes, 10U) << name;
    EXPECT_GE(page.at("panels").size(), 2U) << name;
    bool has_controls = false;
    for (const json& panel : page.at("panels")) {
      has_controls = has_controls || panel.at("title") == "controls";
      for (const json& curve : panel.at("curves")) {
        ASSERT_TRUE(columns.contains(curve.get<std::string>())) << name << curve;
        EXPECT_EQ(columns.at(curve.get<std::string>()).size(), nodes) << name << curve;
      }
      for (const json& band : panel.at("bands")) EXPECT_LT(band[0].get<double>(), band[1].get<double>()) << name;
    }
    EXPECT_TRUE(has_controls) << name;
    const auto require = [&](const json& coordinate) {
      if (!coordinate.is_string() || coordinate == "t") return;
      EXPECT_TRUE(columns.contains(coordinate.get<std::string>())) << name << coordinate;
    };
    for (const json& shape : page.at("shapes")) {
      for (const char* key : {"position", "attitude", "to"})
        for (const json& coordinate : shape.at(key)) require(coordinate);
      for (const json& turn : shape.at("turns")) require(turn.at("angle"));
    }
    const bool has_picture =
        name != "fastest_stop" && name != "around_a_disk" && name != "two_link_arm" && name != "falling_cat";
    EXPECT_EQ(page.at("shapes").empty(), !has_picture) << name;
  }
}

TEST_F(ControlResults, APageHasTheBandsOfThePlot) {
  const fs::path out = folder_ / "stop";
  ASSERT_EQ(run(scene("fastest_stop") + " --out " + out.string()).code, 0);
  const json page = page_of(out);
  const std::string plot = contents_of(out / "plot.gp");
  std::size_t bands = 0;
  for (const json& panel : page.at("panels"))
    if (panel.at("title") == "controls") {
      EXPECT_TRUE(panel.at("steps").get<bool>());
      ASSERT_EQ(panel.at("levels").size(), 2U);
      EXPECT_EQ(panel.at("levels")[0].at("value"), -1);
      bands = panel.at("bands").size();
      for (const json& band : panel.at("bands")) {
        char from[64];
        std::snprintf(from, sizeof from, "rectangle from %.17g, graph 0", band[0].get<double>());
        EXPECT_NE(plot.find(from), std::string::npos) << from;
      }
    }
  EXPECT_GT(bands, 0U);
  EXPECT_NE(contents_of(out / "view.html").find("This system has no picture in space"), std::string::npos);
}

// A summary that is no summary of control any more is told, not crashed on.
TEST_F(ControlResults, ADamagedSummaryIsTold) {
  const fs::path out = folder_ / "stop";
  ASSERT_EQ(run(scene("fastest_stop") + " --out " + out.string()).code, 0);
  json summary = json::parse(contents_of(out / "summary.json"));
  summary.erase("picture");
  std::ofstream(out / "summary.json") << summary;
  expect_refused("view " + out.string(), "is no summary of a run");
}

TEST_F(ControlResults, CostatesHaveNamesAndUnits) {
  const auto costates = [&](const std::string& name) {
    const fs::path out = folder_ / name;
    EXPECT_EQ(run(scene(name) + " --set solver.starts=3 --set horizon.stages=40 --out " + out.string()).code, 0);
    std::vector<std::string> told;
    const json summary = json::parse(contents_of(out / "summary.json"));
    const auto table = lagroid::app::read_csv_table(out / "trajectory.csv", "time", lagroid::app::Gaps::allowed);
    std::vector<std::string> columns, units;
    for (const json& each : summary.at("costates")) {
      columns.push_back(each.at("column"));
      units.push_back(each.at("unit"));
      EXPECT_NE(table.column(columns.back()), lagroid::app::CsvTable::npos) << columns.back();
      told.push_back(columns.back() + " " + units.back());
    }
    // The same in HDF5, a row to an arrow.
    lagroid::app::read_series(out / "control.h5", [&](const std::vector<double>& time, const auto& series) {
      if (series.columns != columns) return;
      EXPECT_EQ(series.first, 1U);
      EXPECT_EQ(time.size(), table.rows.size());
      EXPECT_EQ(series.values[0], table.rows[0][table.column(columns[0])]);
      columns.clear();
    });
    EXPECT_TRUE(columns.empty()) << name << " has no costates in control.h5";
    std::string joined;
    const H5::H5File file((out / "control.h5").string(), H5F_ACC_RDONLY);
    const H5::Attribute unit = file.openDataSet("costates").openAttribute("unit");
    unit.read(unit.getStrType(), joined);
    std::string expected;
    for (const std::string& each : units) expected += (expected.empty() ? "" : ", ") + each;
    EXPECT_EQ(joined, expected);
    return told;
  };
  using Told = std::vector<std::string>;
  EXPECT_EQ(costates("fastest_stop"), (Told{"px s/m", "pv s/(m/s)"}));
  EXPECT_EQ(costates("shortest_way"), (Told{"M s/rad", "p1 s/m", "p2 s/m"}));
  EXPECT_EQ(costates("swing_up"), (Told{"pangle (N m)^2 s/rad", "prate (N m)^2 s/(rad/s)"}));
  EXPECT_EQ(costates("rigid_body").front(), "pM1_source (N m)^2 s/(kg m^2/s)");
  EXPECT_EQ(costates("arm_of_bodies").front(), "upper.ppx_source cost/(kg m/s)");
}

// Along the way a costate of x is constant, and that of v falls by it: which is which is no matter of order.
TEST_F(ControlResults, CostatesBelongToTheirCoordinates) {
  const fs::path out = folder_ / "mass";
  ASSERT_EQ(run(scene("fastest_stop") +
                " --set parameters.cost=effort --set horizon.free=false --set horizon.duration=4 --out " + out.string())
                .code,
            0);
  const auto table = lagroid::app::read_csv_table(out / "trajectory.csv", "time", lagroid::app::Gaps::allowed);
  const std::size_t px = table.column("px"), pv = table.column("pv");
  for (std::size_t k = 1; k + 1 < table.rows.size(); ++k) {
    const double h = table.rows[k][0] - table.rows[k - 1][0];
    EXPECT_NEAR(table.rows[k][px], table.rows[0][px], 1e-9);
    EXPECT_NEAR((table.rows[k][pv] - table.rows[k - 1][pv]) / h, -table.rows[0][px], 1e-8);
  }
}

TEST_F(ControlResults, ConstraintsAreToldByTheirNames) {
  const auto violated = [&](const std::string& arguments) {
    const Outcome r = run(arguments + " --json");
    EXPECT_EQ(r.code, 3) << r.err;
    std::string all = r.err;
    const json found = json::parse(r.out);
    for (const json& each : found.at("violated")) all += each.get<std::string>() + "\n";
    return all;
  };
  const std::string late =
      violated(scene("fastest_stop") + " --set horizon.free=false --set horizon.duration=1 --set solver.starts=1");
  EXPECT_NE(late.find("equation of x in stage "), std::string::npos) << late;
  EXPECT_NE(late.find("; most of all "), std::string::npos) << late;
  const std::string apart =
      violated(scene("through_a_gate") + " --set 'boundary.end_on=[\"x - 6\", \"x - 5\"]' --set solver.starts=1");
  EXPECT_NE(apart.find("\"x - 5\" at the end by "), std::string::npos) << apart;
}

TEST_F(ControlResults, WhatActsIsToldByItsName) {
  const auto active = [&](const std::string& arguments) {
    const Outcome r = run(arguments + " --json");
    EXPECT_EQ(r.code, 0) << r.err;
    std::vector<std::string> names;
    const json found = json::parse(r.out);
    for (const json& each : found.at("active")) {
      names.push_back(each.at("name"));
      for (const json& stages : each.at("stages")) EXPECT_LE(stages[0].get<long>(), stages[1].get<long>());
    }
    return names;
  };
  EXPECT_EQ(active(scene("fastest_stop")), (std::vector<std::string>{"upper bound of u", "lower bound of u"}));
  EXPECT_EQ(active(scene("around_a_disk")), (std::vector<std::string>{"disk_radius"}));
  const std::string few = " --set horizon.stages=30 --set solver.starts=4";
  const auto of_arm = active(scene("arm_of_bodies") + few);
  ASSERT_FALSE(of_arm.empty());
  EXPECT_EQ(of_arm.front().substr(0, 30), "disk about (1, 1, 0) for fore ");
  const fs::path named = write(text_of("arm_of_bodies") +
                               "\n[[constraint]]\nname = 'slow hand'\nkind = 'speed'\nbody = 'fore'\nspeed = 1.5\n");
  const auto of_named = active("control " + named.string() + few);
  EXPECT_NE(std::find(of_named.begin(), of_named.end(), "slow hand"), of_named.end());
}

TEST_F(ControlResults, WhatRepeatsIsToldInASentence) {
  const Outcome r =
      run(scene("through_a_gate") + " --set 'boundary.end_on=[\"x - 6\", \"2*x - 12\"]' --set solver.starts=2 --json");
  const json found = json::parse(r.out);
  ASSERT_EQ(found.at("repeated").size(), 1U) << r.out << r.err;
  EXPECT_EQ(found.at("repeated")[0],
            "\"2*x - 12\" at the end repeats \"x - 6\" at the end: leave one of them out, unless they only touch "
            "there");
  EXPECT_TRUE(json::parse(run(scene("through_a_gate") + " --json --set solver.starts=2").out).at("repeated").empty());
  const fs::path twice = write(text_of("arm_of_bodies") +
                               "\n[[constraint]]\nkind = 'disk'\nbody = 'fore'\nat = [0.5, 0, 0]\n"
                               "centre = [1, 1, 0]\nradius = 0.3\n");
  expect_refused("control " + twice.string(), "constraint.4: says what constraint.3 says: leave one of them out");
  const auto slow = [](const char* speed) {
    return fmt::format("\n[[constraint]]\nname = 'slow'\nkind = 'speed'\nbody = 'fore'\n{}\n", speed);
  };
  const fs::path one_name = write(text_of("arm_of_bodies") + slow("speed = 9") + slow("angular_speed = 9"));
  expect_refused("control " + one_name.string(), "constraint.5.name: is that of constraint.4: give another");
}

// From rest to where a cost of the end and effort are least together: w / (1 + w S) (DoubleIntegrators).
TEST_F(ControlResults, ACostOfTheEndIsAFormula) {
  const fs::path file = folder_ / "towards.toml";
  std::ofstream(file)
      << "control = \"double_integrator\"\n[boundary]\nstart = [0, 0]\nend = [1, 0]\n"
         "free_end = [\"x\", \"v\"]\nend_cost = \"5*(x - 1)^2\"\n[horizon]\nduration = 2\nstages = 20\n";
  const Outcome r = run("control " + file.string() + " --json");
  ASSERT_EQ(r.code, 0) << r.err;
  const double s = 8.0 / 3 - 2 * 0.01 / 12;
  EXPECT_NEAR(json::parse(r.out).at("cost").get<double>(), 5 / (1 + 5 * s), 1e-12);
  EXPECT_NEAR(json::parse(r.out).at("end_cost").get<double>(), 5 / ((1 + 5 * s) * (1 + 5 * s)), 1e-12);
  for (const auto& [set, words] : {std::pair{"boundary.free_end=[]", "end_cost"},
                                   {"boundary.free_end=[\"x\", \"x\"]", "free_end: \"x\" stands there twice"},
                                   {"boundary.end_cost=\"sqrt(x - 1)\"", "no finite number at boundary.end"},
                                   {"boundary.end_cost=\"5*(z - 1)\"", "z"}}) {
    const Outcome refused = run("control " + file.string() + " --set '" + set + "'");
    EXPECT_EQ(refused.code, 2) << set;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_NE(refused.err.find(words), std::string::npos) << refused.err;
  }
}

// [weights] says what a motion costs: time and effort of one force, of which the scene has the closed form.
TEST_F(ControlResults, WeightsTakeThePlaceOfTheCost) {
  const fs::path file = folder_ / "weighed.toml";
  std::ofstream(file) << "control = \"double_integrator\"\n[boundary]\nstart = [0, 0]\nend = [1, 0]\n"
                         "[horizon]\nduration = 3\nfree = true\nstages = 50\n[weights]\nu = 1.0\ntime = 2.25\n";
  const Outcome r = run("control " + file.string() + " --json");
  ASSERT_EQ(r.code, 0) << r.err;
  const json found = json::parse(r.out);
  EXPECT_NEAR(found.at("duration").get<double>(), 2, 2e-3);
  EXPECT_NEAR(found.at("cost").get<double>(), 6, 4e-3);
  EXPECT_EQ(found.at("costates")[0].at("unit"), "cost/m");
  const std::string again = "control " + file.string() + " --set ";
  expect_refused(again + "weights.u=0 --set weights.time=0", "weights: nothing costs: give one of u or time a weight");
  expect_refused(again + "weights.u=-1", "weights.u");
  expect_refused(again + "weights.force=1", "weights.force: unknown key");
  expect_refused(again + "'parameters.cost=\"time\"'", "leave out parameters.cost, or weights");
  expect_refused(again + "weights.u=0 --set horizon.free=false", "all motions cost the same where their time is given");
  // Of a phase its own: twice and three times what each costs.
  const auto cost = [&](const char* first, const char* second) {
    const fs::path phases = folder_ / "weighed_phases.toml";
    std::ofstream(phases) << "control = \"double_integrator\"\n[boundary]\nstart = [0, 0]\nend = [1, 0]\n"
                          << "[weights]\nu = 1.0\n[[phase]]\nduration = 1\nthrough = { x = 0.5, v = 0.5 }\n"
                          << first << "\n[[phase]]\nduration = 1\n"
                          << second << '\n';
    const Outcome two = run("control " + phases.string() + " --json");
    EXPECT_EQ(two.code, 0) << two.err;
    return json::parse(two.out).at("cost").get<double>();
  };
  const double both = cost("", ""), none = cost("weights.u = 0\nweights.time = 1", "");
  EXPECT_NEAR(none, 1 + both / 2, 1e-9);
  EXPECT_NEAR(cost("weights.u = 2", "weights.u = 3"), 2.5 * both, 1e-9);
  EXPECT_NEAR(cost("weights.u = 0", ""), both / 2, 1e-9);
}

TEST_F(ControlResults, BoundsMayBeOnOneSide) {
  const std::string still = " --json --set parameters.cost=effort --set horizon.free=false --set horizon.duration=1.6";
  const auto active = [&](const std::string& bounds) {
    const Outcome r = run(scene("fastest_stop") + still + " --set '" + bounds + "'");
    EXPECT_EQ(r.code, 0) << r.err;
    std::vector<std::string> names;
    const json found = json::parse(r.out);
    for (const json& each : found.at("active")) names.push_back(each.at("name"));
    return names;
  };
  EXPECT_EQ(active("bounds.u={min=-2.2}"), (std::vector<std::string>{"lower bound of u"}));
  EXPECT_EQ(active("bounds.u={max=1.1}"), (std::vector<std::string>{"upper bound of u"}));
  EXPECT_EQ(active("bounds.u={min=-50.0}"), std::vector<std::string>{});
  expect_refused(scene("fastest_stop") + " --set 'bounds.u={}'", "give min, max or both");
  expect_refused(scene("fastest_stop") + " --set 'bounds.u={min=1.0,max=-1.0}'", "1 is not below -1");
  expect_refused(scene("fastest_stop") + " --set 'bounds.u={least=1.0}'", "give min, max or both");
  expect_refused(scene("through_a_gate") + " --set 'phase.0.range={min=4.0}'", "is not between 4 and inf");
  EXPECT_EQ(run(scene("through_a_gate") + " --set 'phase.0.range={max=4.0}' --set solver.starts=2").code, 0);
  EXPECT_EQ(
      run(scene("arm_of_bodies") + " --set 'actuator.0.bounds={max=6.0}' --set horizon.stages=20 --set solver.starts=2")
          .code,
      0);
}

/// A slack that one step leaves at nothing holds all later ones back, the more so the finer the grid.
TEST_F(ControlResults, ThousandsOfStagesConvergeFromOneStart) {
  for (const int stages : {9000, 14000}) {
    const Outcome r =
        run(scene("keep_out") + fmt::format(" --json --set solver.starts=1 --set horizon.stages={}", stages));
    ASSERT_EQ(r.code, 0) << stages << r.err;
    EXPECT_LT(json::parse(r.out).at("iterations").get<int>(), 40) << stages;
  }
}

}  // namespace
}  // namespace app_control_results_tests
