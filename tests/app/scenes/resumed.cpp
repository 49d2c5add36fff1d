// Runs that go on from where they ended, were interrupted or killed: with the same bits.
#include "scenes.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <random>

namespace lagroid::scene_tests::resumed_tests {
namespace {

TEST_F(Scenes, AFinishedRunGoesOnWithTheSameBits) {
  const std::string scene = example("chain_drop") + " --set output.every=7";
  const fs::path whole = folder_ / "whole";
  const fs::path parts = folder_ / "parts";
  ASSERT_EQ(run("run " + scene + " --set time.steps=700 --out " + whole.string()).code, 0);
  ASSERT_EQ(run("run " + scene + " --set time.steps=333 --out " + parts.string()).code, 0);
  const Outcome on = run("resume " + parts.string() + " --set time.steps=700 --json");
  ASSERT_EQ(on.code, 0) << on.err;
  expect_the_same_bits(whole, parts, on.out);
}

/// Of bodies that turn too, wherever they are broken off.
TEST_F(Scenes, BodiesThatTurnGoOnWithTheSameBits) {
  for (const std::string name : {"six_bar", "tops", "rolling_balls"}) {
    const fs::path whole = folder_ / ("whole " + name);
    const fs::path parts = folder_ / ("parts " + name);
    const auto quoted = [](const fs::path& path) { return "'" + path.string() + "'"; };
    ASSERT_EQ(run("run " + example(name) + " --set time.steps=400 --set output.every=1 --out " + quoted(whole)).code,
              0);
    ASSERT_EQ(run("run " + example(name) + " --set time.steps=300 --set output.every=1 --out " + quoted(parts)).code,
              0);
    for (int steps = 305; steps <= 400; steps += 19)
      ASSERT_EQ(run("resume " + quoted(parts) + " --set time.steps=" + std::to_string(steps)).code, 0);
    EXPECT_TRUE(contents(whole / "trajectory.csv") == contents(parts / "trajectory.csv")) << name;
  }
}

/// Of systems, by every kind of steps; a ledger with a balance, first steps by accuracy, every n-th row.
TEST_F(Scenes, SystemsGoOnWithTheSameBits) {
  for (const std::string name :
       {"kepler_adaptive", "kepler_controlled", "kepler_prescribed", "kepler_order_8", "plate_ball_initial_value",
        "plate_ball_adaptive", "rigid_body_moser_veselov", "spherical_pendulum", "damped_pendulum", "driven_pendulum",
        "pythagorean", "kepler --set solver.method=ceres",
        "heavy_top --set time.method=splitting --set output.every=7"}) {
    const fs::path whole = folder_ / ("whole" + std::to_string(entries()));
    const fs::path parts = folder_ / ("parts" + std::to_string(entries()));
    const std::string rest = name.find(' ') == std::string::npos ? "" : name.substr(name.find(' '));
    const std::string scene = "run " + example(name.substr(0, name.find(' '))) + rest + " --set output.checkpoint=50 ";
    ASSERT_EQ(run(scene + "--set time.steps=200 --out " + whole.string()).code, 0) << name;
    ASSERT_EQ(run(scene + "--set time.steps=83 --out " + parts.string()).code, 0) << name;
    ASSERT_EQ(run("resume " + parts.string() + " --set time.steps=150").code, 0) << name;
    const Outcome on = run("resume " + parts.string() + " --set time.steps=200 --json");
    ASSERT_EQ(on.code, 0) << name << on.err;
    SCOPED_TRACE(name);
    expect_the_same_bits(whole, parts, on.out);
  }
}

/// A finished run that is taken up to do no more, one whose last step is recorded besides, one whose step fails.
TEST_F(Scenes, WhatIsTakenUpWithNothingToDoStaysAsItIs) {
  for (const std::string scene : {"rolling_balls --set time.steps=100 --set output.every=7",
                                  "steering --set time.step=0.7 --set time.steps=100000 --set output.every=9",
                                  "spring_pendulum --set time.step=5", "pendulum_adaptive --set time.step=1.5"}) {
    const std::string name = scene.substr(0, scene.find(' '));
    const fs::path out = folder_ / name;
    const int code = run("run " + example(name) + scene.substr(scene.find(' ')) + " --out " + out.string()).code;
    const std::string rows = contents(out / "trajectory.csv");
    auto before = nlohmann::json::parse(contents(out / "summary.json"));
    EXPECT_EQ(run("resume " + out.string()).code, code) << scene;
    auto after = nlohmann::json::parse(contents(out / "summary.json"));
    EXPECT_TRUE(rows == contents(out / "trajectory.csv")) << scene;
    before.erase("seconds");
    after.erase("seconds");
    EXPECT_EQ(before, after) << scene;
  }
}

/// Any bit that is another in a checkpoint is noticed.
TEST_F(Scenes, DamagedCheckpointsAreRefused) {
  const fs::path out = folder_ / "out";
  ASSERT_EQ(run("run " + example("tops") + " --set time.steps=20 --out " + out.string()).code, 0);
  std::mt19937 random(7);
  for (const char* file : {"state.cbor", "rows-000000.cbor", "scene.toml"})
    for (int k = 0; k < 8; ++k) {
      const fs::path kept = out / "checkpoint" / file;
      const std::string good = contents(kept);
      std::string bad = good;
      bad[random() % bad.size()] ^= char(1 << random() % 8);
      std::ofstream(kept, std::ios::binary) << bad;
      EXPECT_EQ(run("resume " + out.string()).code, 2) << file;
      std::ofstream(kept, std::ios::binary) << good;
    }
  EXPECT_EQ(run("resume " + out.string()).code, 0);
}

/// A user's own files in a folder of that name are not ours.
TEST_F(Scenes, AFolderOfThatNameKeepsItsFiles) {
  const fs::path own = folder_ / "out" / "checkpoint" / "mine.txt";
  fs::create_directories(own.parent_path());
  std::ofstream(own) << "mine";
  const std::string out = " --out " + (folder_ / "out").string();
  EXPECT_EQ(run("run " + example("tops") + " --set time.steps=20" + out).code, 0);
  EXPECT_EQ(run("run " + example("tops") + " --set time.steps=20" + out).code, 0);
  EXPECT_EQ(contents(own), "mine");
}

TEST_F(Scenes, TwoRunsDoNotShareAFolder) {
  const fs::path out = folder_ / "out";
  const std::string scene =
      example("tops") + " --set output.every=100000 --set time.steps=100000000 --out " + out.string();
  const Outcome r = run("run " + scene, "(timeout -s INT 3 " + std::string(LAGROID_PROGRAM) + " run " + scene +
                                            " >/dev/null 2>&1 &) ; sleep 1 ; ");
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("another run is at work there"), std::string::npos) << r.err;
  run("list", "sleep 3 ; ");
  EXPECT_EQ(run("resume " + out.string() + " --set time.steps=5").code, 2) << "the first one has more steps";
}

TEST_F(Scenes, AnInterruptedRunGoesOn) {
  const fs::path out = folder_ / "out";
  const Outcome r =
      run("run " + example("tops") + " --set time.steps=100000000 --set output.every=100000 --out " + out.string(),
          "timeout --preserve-status -s INT 1 ");
  EXPECT_EQ(r.code, 4) << r.err;
  EXPECT_NE(r.err.find("lagroid resume"), std::string::npos) << r.err;
  const auto before = nlohmann::json::parse(contents(out / "summary.json")).at("steps").get<long>();
  const Outcome on = run("resume " + out.string() + " --set time.steps=" + std::to_string(before + 1000));
  EXPECT_EQ(on.code, 0) << on.err;
  EXPECT_EQ(nlohmann::json::parse(contents(out / "summary.json")).at("steps"), before + 1000);
}

/// Fifty runs are killed, each where it pleases; each loses at most what came after its last checkpoint.
class Killed : public Scenes {
 protected:
  /// `interval`: steps from one checkpoint to the next.
  void survives(const std::string& name, long interval) {
    const std::string every = std::to_string(interval);
    const std::string scene =
        example(name) + " --set output.every=" + every + " --set output.checkpoint=" + every + " --set time.steps=";
    const fs::path out = folder_ / "killed";
    std::mt19937 random(20261122);
    long reached = 0;
    for (int k = 0; k < 50; ++k) {
      const double moment = 0.02 + 0.0001 * double(random() % 1000);
      const std::string kill = "timeout -s KILL " + std::to_string(moment) + " ";
      const Outcome r =
          run(k == 0 ? "run " + scene + "1000000000 --out " + out.string() : "resume " + out.string(), kill);
      ASSERT_EQ(r.code, 137) << r.err;
      if (!fs::exists(out / "checkpoint" / "state.cbor")) {
        ASSERT_EQ(k, 0) << "a checkpoint is gone";
        k = -1;  // killed before there was anything to lose
        continue;
      }
      const std::string bytes = contents(out / "checkpoint" / "state.cbor").substr(sizeof(std::size_t));
      const auto state = nlohmann::json::from_cbor(bytes).at("state");
      const long now = state.at("steps").get<long>();
      EXPECT_GE(now, reached);
      EXPECT_EQ(now % interval, 0);
      reached = now;
    }
    EXPECT_GT(reached, interval);
    const std::string end = std::to_string(reached + 1000);
    const Outcome last = run("resume " + out.string() + " --set time.steps=" + end);
    ASSERT_EQ(last.code, 0) << last.err;
    const fs::path whole = folder_ / "whole";
    ASSERT_EQ(run("run " + scene + end + " --out " + whole.string()).code, 0);
    EXPECT_TRUE(contents(whole / "trajectory.csv") == contents(out / "trajectory.csv"));
  }
};

TEST_F(Killed, AChainGoesOnWithTheSameBits) { survives("chain_drop", 400); }

TEST_F(Killed, APlateBallGoesOnWithTheSameBits) { survives("plate_ball_initial_value", 2000); }

TEST_F(Scenes, WhatCannotBeTakenUpIsRefused) {
  EXPECT_EQ(run("resume " + (folder_ / "nothing").string()).code, 2);
  const fs::path out = folder_ / "out";
  ASSERT_EQ(run("run " + example("chain_drop") + " --set time.steps=10 --out " + out.string()).code, 0);
  const Outcome other = run("resume " + out.string() + " --set time.step=0.1");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("only time.steps can be set"), std::string::npos) << other.err;
  EXPECT_EQ(run("resume " + out.string() + " --set time.steps=5").code, 2) << "less than it has";
  for (const char* file : {"state.cbor", "rows-000000.cbor", "scene.toml"}) {
    const fs::path broken = out / "checkpoint" / file;
    const std::string good = contents(broken);
    std::ofstream(broken, std::ios::binary) << good.substr(0, good.size() / 2);
    const Outcome r = run("resume " + out.string() + " --set time.steps=20");
    EXPECT_EQ(r.code, 2) << file;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    std::ofstream(broken, std::ios::binary) << good;
  }
  EXPECT_EQ(run("resume " + out.string() + " --set time.steps=20").code, 0);
  const fs::path boundary = folder_ / "boundary";
  ASSERT_EQ(run("run " + example("kepler_boundary") + " --out " + boundary.string()).code, 0);
  EXPECT_EQ(run("resume " + boundary.string()).code, 2) << "a boundary value keeps no checkpoint";
}

}  // namespace
}  // namespace lagroid::scene_tests::resumed_tests
