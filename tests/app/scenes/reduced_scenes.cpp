// Scenes that name a reduction: the full motion back, both momenta in the ledger, and what is refused.
#include "scenes.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <sstream>
#include <vector>

namespace scenes_reduced_scenes_tests {
namespace {

using Rows = std::map<std::string, std::vector<double>>;

/// trajectory.csv by the names of its columns.
Rows rows_of(const fs::path& folder) {
  std::ifstream file(folder / "trajectory.csv");
  std::vector<std::string> names;
  Rows rows;
  std::string line;
  std::getline(file, line);
  std::istringstream head(line.substr(line.find_first_not_of("# ")));
  for (std::string name; std::getline(head, name, ',');) names.push_back(name);
  while (std::getline(file, line)) {
    std::istringstream row(line);
    std::size_t at = 0;
    for (std::string number; std::getline(row, number, ','); ++at)
      if (!number.empty()) rows[names[at]].push_back(std::stod(number));
  }
  return rows;
}

struct Difference {
  double largest = 0;
  std::string column;
};
/// Over all columns of a, relative to one and their size there; b may have more.
Difference difference(const Rows& a, const Rows& b) {
  Difference out{-1, "none"};
  for (const auto& [name, values] : a) {
    const auto found = b.find(name);
    if (found == b.end() || found->second.size() != values.size()) return {INFINITY, name};
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double off = std::abs(values[k] - found->second[k]) / (1 + std::abs(values[k]));
      if (!(off <= out.largest)) out = {off, name};
    }
  }
  return out;
}

/// A scene, a reduction of its system, and how its start is moved by about 1e-7.
struct Reduced {
  std::string scene;
  std::string by;
  std::string moved;
};

class ReducedScenes : public CommandLine {
 protected:
  Rows rows(const std::string& name, const std::string& scene) const {
    const fs::path out = folder_ / name;
    const Outcome r = run("run " + scene + " --out " + out.string());
    EXPECT_EQ(r.code, 0) << scene << r.err;
    return rows_of(out);
  }
  nlohmann::json summary(const std::string& scene) const {
    const Outcome r = run("run " + scene + " --json");
    EXPECT_EQ(r.code, 0) << scene << r.err;
    return nlohmann::json::parse(r.out);
  }
  static const nlohmann::json* entry(const nlohmann::json& run, const std::string& name) {
    for (const auto& each : run.at("ledger").at("entries"))
      if (each.at("name") == name) return &each;
    return nullptr;
  }
};

TEST_F(ReducedScenes, HaveTheFullMotion) {
  const std::string kepler = example("kepler") + " --set time.steps=1000";
  const std::vector<Reduced> scenes{
      {kepler, "rotations", "initial.momentum=[0,2.0000002]"},
      {kepler + " --set time.order=4", "rotations", "initial.momentum=[0,2.0000002]"},
      {example("kepler_adaptive") + " --set time.steps=300", "rotations", "initial.momentum=[0,2.0000002]"},
      {kepler, "angular-momentum", "initial.momentum=[0,2.0000002]"},
      {kepler + " --set time.order=4", "angular-momentum", "initial.momentum=[0,2.0000002]"},
      {example("heavy_top") + " --set time.steps=1000", "vertical-momentum", "initial.momentum=[0,0,2.50000025]"},
      {example("gyrostat") + " --set time.steps=1000", "rotor-momenta",
       "initial.momentum=[0.3,1.50000015,0.4,0.2,-0.1,0.3]"},
      {example("rolling_ball") + " --set time.steps=1000", "rotations", "initial.velocity=[0,0.30000003]"},
      {example("rolling_ball") + " --set parameters.plate_rate=0 --set time.steps=1000", "translations",
       "initial.velocity=[0,0.30000003]"},
      {example("plate_ball_initial_value") + " --set time.steps=1000", "rotations",
       "initial.momentum=[0.90000009,0.2,0.6,-0.4,0.8]"},
      {example("plate_ball_initial_value") + " --set parameters.plate_rate=0 --set time.steps=1000", "translations",
       "initial.momentum=[0.90000009,0.2,0.6,-0.4,0.8]"}};
  for (const Reduced& each : scenes) {
    SCOPED_TRACE(each.scene + " by " + each.by);
    const std::string number = std::to_string(entries());
    const Rows full = rows("full" + number, each.scene);
    const Rows back = rows("back" + number, each.scene + " --set reduce=" + each.by);
    const Rows beside = rows("beside" + number, each.scene + " --set " + each.moved);
    const double growth = std::max(1.0, difference(full, beside).largest / 1e-7);
    const Difference off = difference(full, back);
    EXPECT_LE(off.largest, 1e-12 * growth) << off.column;
    EXPECT_GT(back.size(), full.size()) << "the reduced momentum is recorded beside the full one";
  }
}

TEST_F(ReducedScenes, KeepBothMomentaInTheLedger) {
  const auto run = summary(example("kepler") + " --set time.steps=1000 --set reduce=rotations");
  for (const char* name : {"energy", "angular momentum", "reduced angular momentum"}) {
    const auto* found = entry(run, name);
    ASSERT_NE(found, nullptr) << name;
    EXPECT_NE(found->at("verdict"), "BROKEN") << *found;
  }
  EXPECT_NE(run.at("notes").dump().find("reduced by"), std::string::npos);
}

TEST_F(ReducedScenes, TellThePhasesOfAFixedMomentum) {
  // A turn and a half of the ellipse: the angle is dynamic, for the radius alone turns nothing.
  const auto run = summary(example("kepler_reduced") + " --set time.steps=943 --set output.every=100");
  const auto* fixed = entry(run, "fixed angular-momentum");
  ASSERT_NE(fixed, nullptr);
  EXPECT_EQ(fixed->at("verdict"), "kept") << *fixed;
  const auto* dynamic = entry(run, "dynamic phase");
  const auto* geometric = entry(run, "geometric phase");
  ASSERT_TRUE(dynamic && geometric);
  EXPECT_EQ(geometric->at("final").at(0), 0.0);
  const auto& at = run.at("final").at("position");
  const double angle = std::atan2(at.at(1).get<double>(), at.at(0).get<double>());
  EXPECT_NEAR(std::remainder(dynamic->at("final").at(0).get<double>() - angle, 2 * M_PI), 0, 1e-12);
  EXPECT_GT(dynamic->at("final").at(0), 2 * M_PI) << "angles count turns";
}

TEST_F(ReducedScenes, GoOnWithTheSameBits) {
  for (const std::string& scene :
       {example("kepler") + " --set reduce=rotations", example("kepler") + " --set reduce=rotations --set time.order=4",
        example("kepler_adaptive") + " --set reduce=rotations",
        example("heavy_top") + " --set reduce=vertical-momentum",
        example("gyrostat") + " --set reduce=rotor-momenta --set time.order=4", example("kepler_reduced"),
        example("kepler_reduced") + " --set time.order=4"}) {
    const fs::path whole = folder_ / ("whole" + std::to_string(entries()));
    const fs::path parts = folder_ / ("parts" + std::to_string(entries()));
    ASSERT_EQ(run("run " + scene + " --set time.steps=300 --out " + whole.string()).code, 0) << scene;
    ASSERT_EQ(run("run " + scene + " --set time.steps=130 --out " + parts.string()).code, 0) << scene;
    const Outcome on = run("resume " + parts.string() + " --set time.steps=300 --json");
    ASSERT_EQ(on.code, 0) << scene << on.err;
    SCOPED_TRACE(scene);
    lagroid::scene_tests::expect_the_same_bits(whole, parts, on.out);
  }
}

TEST_F(ReducedScenes, RefuseWhatTheyCannotDo) {
  const std::string kepler = "run " + example("kepler") + " --set time.steps=10 --set reduce=";
  expect_refused(kepler + "translations", "\"translations\" is none of rotations, angular-momentum");
  expect_refused(kepler + "rotations --set time.method=splitting", "the system reduced by \"rotations\" has no");
  expect_refused(kepler + "angular-momentum --set time.mode=adaptive", "reduced by \"angular-momentum\" has no");
  expect_refused("run " + example("plate_ball_initial_value") + " --set reduce=translations",
                 "\"translations\" is no symmetry of this system: the constraint does not descend: at the arrow");
  expect_refused("run " + example("rolling_ball") + " --set reduce=translations",
                 "\"translations\" is no symmetry of this system: the constraint does not descend: at the arrow");
  expect_refused("run " + example("plate_ball_initial_value") + " --set initial.position=[0,0] --set reduce=rotations",
                 "does not act freely at the object");
  expect_refused("run " + example("rolling_ball") + " --set initial.position=[0,0] --set reduce=rotations",
                 "does not act freely at the object");
  expect_refused("run " + example("kepler_boundary") + " --set reduce=rotations", "reduce: goes with [initial]");
  expect_refused("run " + example("pendulum") + " --set reduce=rotations", "declares nothing by which it is reduced");
  const Outcome too_long = run(kepler + "angular-momentum --set time.step=2.5");
  EXPECT_EQ(too_long.code, 3);
  EXPECT_NE(too_long.err.find("no arrow near has the fixed momentum"), std::string::npos) << too_long.err;
}

TEST_F(ReducedScenes, RunWithoutTranslationsOrRotations) {
  for (const char* scene : {"rolling_ball_reduced", "plate_ball_reduced"}) {
    const auto run = summary(example(scene));
    EXPECT_NE(run.at("notes").dump().find("reduced by"), std::string::npos) << scene;
    for (const auto& each : run.at("ledger").at("entries")) EXPECT_NE(each.at("verdict"), "BROKEN") << each;
  }
}

TEST_F(ReducedScenes, AreListed) {
  const auto systems = nlohmann::json::parse(run("list --json").out);
  for (const auto& system : systems) {
    if (system.at("name") != "kepler") continue;
    EXPECT_EQ(system.at("reductions").at(0).at("name"), "rotations");
    EXPECT_EQ(system.at("reductions").at(0).at("groupoid"), "Pair<1> x SO(2)");
  }
  EXPECT_NE(run("list").out.find("reduced by         rotations"), std::string::npos);
}

TEST_F(ReducedScenes, AreStudied) {
  const Outcome r = run("study " + example("kepler") + " --set time.steps=200 --set reduce=rotations --list");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("variational"), std::string::npos) << r.out;
  EXPECT_EQ(r.out.find("splitting"), std::string::npos) << "of the full system alone: " << r.out;
}

}  // namespace
}  // namespace scenes_reduced_scenes_tests
