// What `lagroid run` computes and reports of motions.
#include "../command_line.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <string>
#include <vector>

namespace command_line_runs_tests {
namespace {

TEST_F(CommandLine, ALastNodeThatIsNotFiniteIsNoSuccess) {
  // Velocities overflow in steps this small; the last node alone is recorded.
  const Outcome r = run("run " + example("chain_drop") + " --set time.step=1e-300 --set time.steps=2");
  EXPECT_EQ(r.code, 3);
  EXPECT_NE(r.err.find("no finite numbers at the end"), std::string::npos) << r.err;
}

/// No verdict is passed on numbers that are none, and what has no digits is refused.
TEST_F(CommandLine, UnitsDoNotMatterOrTheirLimitIsSaid) {
  const auto energy = [](const Outcome& r) { return nlohmann::json::parse(r.out).at("ledger").at("entries").at(0); };
  const auto place = [](const Outcome& r) {
    return nlohmann::json::parse(r.out).at("final").at("position").at(0).get<double>();
  };
  const std::string scene = "run " + example("pendulum") + " --json --set time.steps=2000 ";
  const Outcome plain = run(scene);
  EXPECT_EQ(energy(plain).at("verdict"), "bounded");
  for (const std::string mass : {"1e200", "1e300", "1e-160", "1e-280"})
    for (const std::string more : {"", "--set time.order=4 ", "--set time.method=splitting ",
                                   "--set time.mode=controlled ", "--set time.mode=adaptive "}) {
      const Outcome r = run(scene + more + "--set parameters.mass=" + mass);
      ASSERT_EQ(r.code, 0) << r.err;
      EXPECT_EQ(energy(r).at("verdict"), "bounded") << more << mass;
      if (more.empty()) {
        EXPECT_NEAR(place(r), place(plain), 1e-9) << mass;
      }
      EXPECT_LT(energy(r).at("relative_drift").get<double>(), 0.1);
    }
  const Outcome light = run(scene + "--set parameters.mass=1e-300");
  EXPECT_EQ(light.code, 3) << light.out;
  EXPECT_EQ(nlohmann::json::parse(light.out).at("steps"), 0);
  for (const std::string key : {"parameters.length=1e-320", "parameters.length=1e-200", "parameters.length=1e200",
                                "parameters.mass=1e-320", "time.step=1e308", "time.step=1e-320"}) {
    const Outcome r = run(scene + "--set " + key);
    EXPECT_EQ(r.code, 2) << key;
    // Of a mass that is too small what is told is the inertia, at the key of the length.
    const bool named = r.err.find(key.substr(0, key.find('='))) != std::string::npos;
    EXPECT_TRUE(named || r.err.find("m l^2") != std::string::npos) << r.err;
  }
}

/// Extrapolation goes by its tolerance, whatever the units, and is refused where it has none or nothing to go by.
TEST_F(CommandLine, ExtrapolationFollowsItsTolerance) {
  const auto place = [](const Outcome& r) {
    EXPECT_EQ(r.code, 0) << r.err;
    return nlohmann::json::parse(r.out).at("final").at("position").at(0).get<double>();
  };
  const std::string pendulum = "run " + example("pendulum") + " --json --set time.step=0.1 --set time.steps=200 ";
  const std::string by = pendulum + "--set time.method=extrapolation --set time.tolerance=";
  const double fine = place(run(pendulum + "--set time.step=0.001 --set time.steps=20000 --set time.method=splitting "
                                           "--set time.order=8"));
  EXPECT_NEAR(place(run(by + "1e-6")), fine, 1e-4);
  EXPECT_NEAR(place(run(by + "1e-12")), fine, 1e-9);
  for (const std::string mass : {"1e200", "1e300", "1e-160", "1e-280"})
    EXPECT_NEAR(place(run(by + "1e-12 --set parameters.mass=" + mass)), fine, 1e-9) << mass;
  expect_refused(pendulum + "--set time.method=extrapolation", "time.method: takes its order and its steps");
  expect_refused(pendulum + "--set time.tolerance=1e-9", "time.tolerance: goes with method = \"extrapolation\"");
  expect_refused(by + "1e-9 --set time.order=8", "follows its tolerance; leave it out");
  expect_refused(by + "1e-9 --set time.composition=suzuki", "time.composition: goes with steps that are composed");
  expect_refused("run " + example("damped_pendulum") + " --set time.method=extrapolation --set time.tolerance=1e-9",
                 "has no explicit splitting");
}

/// Far from the origin a step moves positions by less than they can tell: what is kept then says nothing of the motion.
TEST_F(CommandLine, PositionsWithoutTheDigitsOfTheMotionAreUnjudged) {
  const auto verdicts = [&](const std::string& x) {
    const Outcome r = run("run " + example("kepler") + " --json --set time.steps=200 --set initial.momentum=[0,1] " +
                          "--set initial.position=[" + x + ",0]");
    std::vector<std::string> out;
    for (const auto& entry : nlohmann::json::parse(r.out).at("ledger").at("entries"))
      out.push_back(entry.at("verdict"));
    return out;
  };
  for (const std::string& verdict : verdicts("1e17")) EXPECT_EQ(verdict, "unjudged");
  for (const std::string& verdict : verdicts("1e3")) EXPECT_NE(verdict, "unjudged");
}

TEST_F(CommandLine, AFallThroughTheCentreHasNoBoundedEnergy) {
  const Outcome r = run("run " + example("kepler") + " --json --set initial.momentum=[0,0]");
  const auto energy = nlohmann::json::parse(r.out).at("ledger").at("entries").at(0);
  EXPECT_GT(energy.at("relative_drift").get<double>(), 1);
  EXPECT_EQ(energy.at("verdict"), "BROKEN") << energy;
  EXPECT_TRUE(energy.contains("reason"));
}

TEST_F(CommandLine, EveryExampleRuns) {
  for (const auto& entry : fs::directory_iterator(LAGROID_EXAMPLES)) {
    if (entry.path().extension() != ".toml") continue;
    const Outcome r = run("run " + entry.path().string() + " --json");
    EXPECT_EQ(r.code, 0) << entry.path() << r.err;
    const auto json = nlohmann::json::parse(r.out);
    EXPECT_EQ(json.at("status"), "converged");
    for (const char* key :
         {"steps", "seconds", "iterations", "initial", "final", "multipliers", "stationary_paths", "ledger"})
      EXPECT_TRUE(json.contains(key)) << key;
    for (const auto& e : json.at("ledger").at("entries")) EXPECT_NE(e.at("verdict"), "BROKEN") << entry.path() << e;
  }
}

TEST_F(CommandLine, RunHandsOverWhatIsNoMotion) {
  for (const auto& entry : fs::directory_iterator(LAGROID_EXAMPLES "/optimisation")) {
    if (entry.path().extension() != ".toml") continue;
    const Outcome by_run = run("run " + entry.path().string() + " --json");
    ASSERT_EQ(by_run.code, 0) << entry.path() << by_run.err;
    const Outcome by_name = run("optimize " + entry.path().string() + " --json");
    const auto same = nlohmann::json::parse(by_run.out), other = nlohmann::json::parse(by_name.out);
    EXPECT_EQ(same.at("value"), other.at("value")) << entry.path();
  }
  const std::string sweep = example("sweeps/kepler") + " --set design.count=3";
  expect_refused("run " + sweep, "give --out DIR");
  const Outcome swept = run("run " + sweep + " --out " + (folder_ / "swept").string());
  EXPECT_EQ(swept.code, 0) << swept.err;
  EXPECT_TRUE(fs::exists(folder_ / "swept" / "members.csv"));
  for (const char* command : {"view ", "plot "})
    expect_refused(command + (folder_ / "swept").string(), "and not a run");
}

TEST_F(CommandLine, CommandsForMotionsNameTheOneForOtherScenes) {
  expect_refused("study " + example("optimisation/membrane"), "lagroid optimize carries it out");
  expect_refused("study " + example("sweeps/kepler"), "lagroid sweep carries it out");
  expect_refused("optimize " + example("kepler"), "lagroid run carries it out");
  expect_refused("sweep " + example("kepler") + " --out nowhere", "lagroid run carries it out");
  expect_refused("sweep " + example("optimisation/membrane") + " --out nowhere", "lagroid optimize carries it out");
  expect_refused("study " + example("kepler") + " --budget nan", "--budget: give a number between 0.1 and 1e+07");
}

TEST_F(CommandLine, CeresGivesTheSameTrajectory) {
  const std::string scene = example("plate_ball_initial_value");
  const auto newton = nlohmann::json::parse(run("run " + scene + " --json").out);
  const auto ceres = nlohmann::json::parse(run("run " + scene + " --json --set solver.method=ceres").out);
  EXPECT_NEAR(newton.at("final").at("position").at(0).get<double>(),
              ceres.at("final").at("position").at(0).get<double>(), 1e-11);
}

TEST_F(CommandLine, AFailingStepKeepsWhatWasComputed) {
  const fs::path out = folder_ / "partial";
  const Outcome r = run("run " + example("plate_ball_initial_value") +
                        " --set time.steps=20000 --set parameters.rotation=exp --out " + out.string() + " --json");
  EXPECT_EQ(r.code, 3) << r.err;
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_NE(json.at("status"), "converged");
  const long done = json.at("steps");
  EXPECT_GT(done, 1000);
  EXPECT_LT(done, 20000);
  EXPECT_NE(json.at("message").get<std::string>().find("step " + std::to_string(done + 1)), std::string::npos);
  std::ifstream csv(out / "trajectory.csv");
  std::string line;
  long lines = 0;
  while (std::getline(csv, line)) ++lines;
  EXPECT_EQ(lines, done + 2);
}

TEST_F(CommandLine, TooManyStepsForTheMemoryAreNamed) {
  if (std::string(LAGROID_PROGRAM).find("sanitizers") != std::string::npos)
    GTEST_SKIP() << "AddressSanitizer needs the whole address space";
  const Outcome r =
      run("run " + example("kepler_boundary") + " --json --set time.steps=20000000", "ulimit -v 1500000; ");
  EXPECT_EQ(r.code, 3) << r.err;
  EXPECT_NE(r.err.find("out of memory; lower time.steps"), std::string::npos) << r.err;
  EXPECT_EQ(nlohmann::json::parse(r.out).at("status"), "out_of_memory");
}

TEST_F(CommandLine, CeresKeepsQuietOnStandardError) {
  const Outcome r = run("run " + example("rigid_body") + " --set solver.method=ceres --set parameters.rotation=cayley");
  EXPECT_EQ(r.code, 0);
  EXPECT_EQ(r.err, "");
}

/// What Newton's method integrates, Ceres integrates: two thousand steps of every example that says who solves its
/// steps.
TEST_F(CommandLine, CeresDoesAllStepsOfEveryExample) {
  int asked = 0;
  for (const auto& file : fs::directory_iterator(LAGROID_EXAMPLES)) {
    if (file.path().extension() != ".toml") continue;
    std::ifstream in(file.path());
    const std::string scene{std::istreambuf_iterator<char>(in), {}};
    if (scene.find("\n[initial]") == std::string::npos) continue;
    const std::string arguments = "run " + file.path().string() + " --set time.steps=2000";
    const Outcome by_ceres = run(arguments + " --set solver.method=ceres");
    if (by_ceres.code == 2) continue;  // explicit steps
    ++asked;
    EXPECT_EQ(by_ceres.code, run(arguments).code) << file.path() << ": " << by_ceres.err;
    EXPECT_EQ(by_ceres.err.find("trust_region"), std::string::npos) << by_ceres.err;
  }
  EXPECT_GE(asked, 10);
  const Outcome shorter = run("run " + example("heavy_top") + " --set solver.method=ceres --set time.step=0.01");
  EXPECT_EQ(shorter.code, 0) << shorter.err;
  EXPECT_EQ(shorter.err, "");
}

TEST_F(CommandLine, AdaptiveStepsKeepTheDiscreteEnergyOrSayThatNoneDoes) {
  const fs::path out = folder_ / "adaptive";
  const Outcome kept = run("run " + example("pendulum_adaptive") + " --json --out " + out.string());
  ASSERT_EQ(kept.code, 0) << kept.err;
  bool found = false;
  const auto summary = nlohmann::json::parse(kept.out);
  for (const auto& entry : summary.at("ledger").at("entries"))
    if (entry.at("name") == "discrete energy E_d") {
      found = true;
      EXPECT_EQ(entry.at("verdict"), "kept");
      EXPECT_LT(entry.at("relative_drift"), 1e-12);
    }
  EXPECT_TRUE(found);
  std::ifstream csv(out / "trajectory.csv");
  std::string header;
  std::getline(csv, header);
  EXPECT_NE(header.find(",h"), std::string::npos) << header;

  const Outcome none = run("run " + example("pendulum_adaptive") + " --json --set parameters.quadrature=trapezoid");
  EXPECT_EQ(none.code, 3);
  EXPECT_EQ(nlohmann::json::parse(none.out).at("status"), "no_step");
  const Outcome carried = run("run " + example("pendulum_adaptive") +
                              " --json --set parameters.quadrature=trapezoid --set time.without_root=constant");
  EXPECT_EQ(carried.code, 0) << carried.err;
  EXPECT_NE(carried.out.find("the discrete energy determines no positive step size"), std::string::npos);
}

TEST_F(CommandLine, RefusesTimesThatTheSystemDoesNotHave) {
  for (const char* wrong : {"kepler --set time.order=5",
                            "kepler --set time.order=4 --set time.composition=kahan-li-8",
                            "kepler_adaptive --set time.order=4",
                            "rolling_ball --set time.mode=adaptive",
                            "damped_pendulum --set time.order=4",
                            "rigid_body_moser_veselov --set time.step=5",
                            "rolling_disk --set time.method=splitting",
                            "pendulum --set time.mode=transformed",
                            "rolling_disk --set time.method=runge-kutta",
                            "rigid_body --set time.method=splitting --set time.composition=nystrom-6",
                            "kepler --set time.mode=transformed --set time.composition=nystrom-6",
                            "damped_pendulum --set time.method=splitting",
                            "driven_body --set time.method=splitting",
                            "kepler --set time.accuracy=1e-3",
                            "rigid_body_moser_veselov --set time.accuracy=1e-3",
                            "kepler_boundary --set time.accuracy=1e-3",
                            "kepler_adaptive --set time.method=splitting",
                            "rigid_body_moser_veselov --set time.mode=adaptive",
                            "driven_pendulum --set time.start=1e17",
                            "kepler_controlled --set time.accuracy=0",
                            "driven_pendulum --set time.mode=controlled"}) {
    const std::string words = wrong;
    const auto space = words.find(' ');
    expect_refused("run " + example(words.substr(0, space)) + words.substr(space), "time.");
  }
}

TEST_F(CommandLine, AnInterruptedRunKeepsWhatWasComputed) {
  for (const std::string signal : {"INT", "TERM"}) {
    const fs::path out = folder_ / signal;
    const Outcome r = run("run " + example("kepler") +
                              " --json --set time.steps=900000000 --set output.every=100000 --out " + out.string(),
                          "timeout --preserve-status -s " + signal + " 2 ");
    EXPECT_EQ(r.code, 4) << r.err;
    EXPECT_NE(r.err.find("interrupted after step"), std::string::npos) << r.err;
    const auto summary = nlohmann::json::parse(r.out);
    EXPECT_EQ(summary.at("status"), "interrupted");
    EXPECT_GT(summary.at("steps"), 0);
    EXPECT_EQ(summary.at("ledger").at("solver").at("verdict"), "kept");
    for (const char* file : {"trajectory.h5", "trajectory.csv", "summary.json", "plot.svg"})
      EXPECT_TRUE(fs::exists(out / file)) << file;
  }
}

}  // namespace
}  // namespace command_line_runs_tests
