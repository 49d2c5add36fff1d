// Exit codes, JSON and files of the program.
#include "command_line.hpp"

#include <H5Cpp.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

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

TEST_F(CommandLine, APipeThatNobodyReadsIsAnErrorAndLeavesNoLock) {
  const std::string out = (folder_ / "piped").string();
  run("run " + example("kepler") + " --set time.steps=5 --out " + out + " | true");
  EXPECT_TRUE(fs::exists(out + "/summary.json"));
  EXPECT_FALSE(fs::exists(out + "/.lock"));
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
    for (const char* key : {"steps", "seconds", "iterations", "initial", "final", "multipliers", "minima", "ledger"})
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

TEST_F(CommandLine, BoundaryValueJson) {
  const Outcome r = run("run " + example("plate_ball") + " --json");
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_NEAR(json.at("cost").get<double>(), 7.2978550783250329880, 1e-11);
  EXPECT_EQ(json.at("minima").at(0).at("is_minimum"), true);
  EXPECT_EQ(json.at("minima").at(0).at("momentum").size(), 5U);
  EXPECT_EQ(json.at("final").at("attitude").size(), 4U);
  EXPECT_EQ(json.at("multipliers").at("first").size(), 3U);
  EXPECT_NEAR(json.at("final").at("position").at(0).get<double>(), 1.0, 1e-14);
}

TEST_F(CommandLine, EveryMethodSolvesTheSameBoundaryValues) {
  for (const char* scene : {"kepler_boundary", "rigid_body_boundary", "unicycle"}) {
    std::vector<double> costs;
    for (const char* method : {"newton", "shooting", "ceres"}) {
      const Outcome r = run("run " + example(scene) +
                            " --json --set time.steps=60 --set solver.starts=4 --set solver.method=" + method);
      ASSERT_EQ(r.code, 0) << r.err;
      costs.push_back(nlohmann::json::parse(r.out).at("cost"));
    }
    EXPECT_NEAR(costs[0], costs[1], 1e-9) << scene;
    EXPECT_NEAR(costs[0], costs[2], 1e-9) << scene;
  }
}

TEST_F(CommandLine, ContinuationArrivesWhereTheDirectSolveDoes) {
  const std::string scene = "run " + example("rigid_body_boundary") + " --json";
  const auto direct = nlohmann::json::parse(run(scene).out);
  const Outcome r = run(scene +
                        " --set continuation.parameter=parameters.inertia --set continuation.from=[2,2,2] "
                        "--set continuation.steps=4");
  ASSERT_EQ(r.code, 0) << r.err;
  const auto carried = nlohmann::json::parse(r.out);
  EXPECT_NEAR(carried.at("cost").get<double>(), direct.at("cost").get<double>(), 1e-9);
  EXPECT_NE(carried.at("notes").dump().find("arrived"), std::string::npos);
}

TEST_F(CommandLine, ContinuationKeepsEndsWhereTheyMustLie) {
  // Between the two ends given, positions are brought back to the sphere and quaternions to unit norm.
  const std::string sphere = folder_.string() + "/sphere.toml";
  std::ofstream(sphere) << "system = 'spherical_pendulum'\n[time]\nduration = 1.0\nsteps = 40\n"
                           "[boundary]\nstart = { position = [0.6, 0, -0.8] }\nend = { position = [0, 0.6, -0.8] }\n"
                           "[solver]\nstarts = 4\n[continuation]\nparameter = 'boundary.end.position'\n"
                           "from = [0.8, 0, -0.6]\n";
  const Outcome r = run("run " + sphere + " --json");
  ASSERT_EQ(r.code, 0) << r.err;
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_NEAR(json.at("final").at("position").at(1).get<double>(), 0.6, 1e-12);
  EXPECT_NE(json.at("notes").dump().find("arrived"), std::string::npos);
  EXPECT_EQ(run("run " + sphere + " --set continuation.from=[0.8,0,-0.5]").code, 2) << "an end the user wrote";
  const Outcome turned = run("run " + example("rigid_body_boundary") +
                             " --json --set solver.starts=4 --set boundary.end.attitude=[0.6,0,0.8,0]"
                             " --set continuation.parameter=boundary.end.attitude --set continuation.from=[1,0,0,0]");
  EXPECT_EQ(turned.code, 0) << turned.err;
}

TEST_F(CommandLine, BadBoundaryValuesExitTwo) {
  const std::string sphere = "run " + example("spherical_pendulum") + " --set boundary.start.position=[1,0,0] ";
  for (const std::string& arguments : std::vector<std::string>{
           sphere + "--set boundary.end.position=[0,1,0]",  // [initial] as well
           "run " + example("kepler_boundary") + " --set boundary.end.position=[0,0]",
           "run " + example("kepler_boundary") + " --set time.steps=1",
           "run " + example("kepler_boundary") + " --set solver.method=shoot",
           "run " + example("kepler_boundary") + " --set solver.seek=maxima",
           "run " + example("kepler_boundary") + " --set boundary.end.attitude=[0,0,1]",
           "run " + example("kepler_boundary") +
               " --set continuation.parameter=parameters.mass --set continuation.from=1",
           "run " + example("plate_ball_continuation") + " --set continuation.parameter=boundary.end.position",
           "run " + example("plate_ball_continuation") + " --set continuation.parameter=time.steps",
           "run " + example("plate_ball_continuation") + " --set continuation.parameter=solver.starts",
           "run " + example("plate_ball_continuation") + " --set continuation.step=4"}) {
    const Outcome r = expect_refused(arguments + " --json");
    EXPECT_EQ(nlohmann::json::parse(r.out).at("status"), "invalid_scene");
  }
}

TEST_F(CommandLine, CeresGivesTheSameTrajectory) {
  const std::string scene = example("plate_ball_initial_value");
  const auto newton = nlohmann::json::parse(run("run " + scene + " --json").out);
  const auto ceres = nlohmann::json::parse(run("run " + scene + " --json --set solver.method=ceres").out);
  EXPECT_NEAR(newton.at("final").at("position").at(0).get<double>(),
              ceres.at("final").at("position").at(0).get<double>(), 1e-11);
}

TEST_F(CommandLine, WritesEveryFileWhole) {
  const fs::path out = folder_ / "a" / "b";
  const Outcome r = run("run " + example("plate_ball_initial_value") + " --out " + out.string());
  EXPECT_EQ(r.code, 0) << r.err;
  for (const char* name :
       {"trajectory.h5", "trajectory.csv", "summary.json", "summary.txt", "plot.gp", "plot.svg", "plot.png"})
    EXPECT_GT(fs::file_size(out / name), 100U) << name;
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "a"), fs::directory_iterator()), 1) << "staging left behind";
  std::ifstream csv(out / "trajectory.csv");
  std::string line;
  long lines = 0;
  while (std::getline(csv, line)) ++lines;
  EXPECT_EQ(lines, 202);
}

TEST_F(CommandLine, OutputEvery) {
  const fs::path out = folder_ / "thin";
  EXPECT_EQ(run("run " + example("pendulum") + " --set output.every=300 --out " + out.string()).code, 0);
  std::ifstream csv(out / "trajectory.csv");
  std::string line;
  long lines = 0;
  while (std::getline(csv, line)) ++lines;
  EXPECT_EQ(lines, 1 + 5) << "header, nodes 0, 300, 600, 900 and 1000";
}

TEST_F(CommandLine, BadScenesExitTwoAndWriteNothing) {
  const fs::path out = folder_ / "none";
  for (const std::string& arguments : std::vector<std::string>{
           "run /no/such/scene.toml", "run " + example("plate_ball") + " --set time.steps=2",
           "run " + example("plate_ball") + " --set parameters.radius=-1",
           "run " + example("plate_ball") + " --set boundary.end.attitude=[1,1,0,0]",
           "run " + example("plate_ball") + " --set parameters.rotation=trace --set parameters.spin=60"}) {
    const Outcome r = expect_refused(arguments + " --out " + out.string() + " --json");
    EXPECT_FALSE(fs::exists(out));
    EXPECT_EQ(nlohmann::json::parse(r.out).at("status"), "invalid_scene");
  }
  const Outcome no_scene = expect_refused("run --json");
  EXPECT_EQ(nlohmann::json::parse(no_scene.out).at("status"), "invalid_command_line");
  EXPECT_EQ(run("run " + example("pendulum") + " --out ''").code, 2);
  EXPECT_EQ(run("run").code, 2);
  EXPECT_EQ(run("").code, 2);
  EXPECT_EQ(run("run " + example("plate_ball") + " --frobnicate").code, 2);
  EXPECT_EQ(entries(), 1U) << "only the captured stderr";
}

TEST_F(CommandLine, WritesIntoAFolderWhoseParentIsNotWritable) {
  const fs::path parent = folder_ / "parent";
  const fs::path out = parent / "mine";
  fs::create_directories(out);
  std::ofstream(out / "plot.svg") << "of an earlier run";
  fs::permissions(parent, fs::perms::owner_read | fs::perms::owner_exec);
  const Outcome r = run("run " + example("pendulum") + " --set time.steps=1 --out " + out.string());
  fs::permissions(parent, fs::perms::owner_all);
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_GT(fs::file_size(out / "plot.svg"), 100U);
  EXPECT_EQ(std::distance(fs::directory_iterator(parent), fs::directory_iterator()), 1) << "nothing beside the folder";
}

TEST_F(CommandLine, Hdf5HoldsWhatTheCsvHolds) {
  const fs::path out = folder_ / "both";
  ASSERT_EQ(run("run " + example("plate_ball_initial_value") + " --out " + out.string()).code, 0);
  H5::H5File file((out / "trajectory.h5").string(), H5F_ACC_RDONLY);
  const H5::DataSet position = file.openDataSet("position");
  std::vector<double> values(std::size_t(position.getSpace().getSimpleExtentNpoints()));
  ASSERT_EQ(values.size(), 2U * 201U);
  position.read(values.data(), H5::PredType::NATIVE_DOUBLE);
  std::string unit;
  const H5::Attribute attribute = position.openAttribute("unit");
  attribute.read(attribute.getStrType(), unit);
  EXPECT_EQ(unit, "m");
  EXPECT_TRUE(file.attrExists("convention: attitude"));
  std::ifstream csv(out / "trajectory.csv");
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line.substr(0, 6), "t,x,y,");
  for (std::size_t k = 0; std::getline(csv, line); ++k) {
    double t = 0;
    double x = 0;
    double y = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &t, &x, &y), 3);
    EXPECT_EQ(x, values[2 * k]);
    EXPECT_EQ(y, values[2 * k + 1]);
    EXPECT_NEAR(t, 0.02 * double(k), 1e-14);
  }
}

TEST_F(CommandLine, UnwritableFolderIsRefusedBeforeRunning) {
  const fs::path file = folder_ / "file";
  std::ofstream(file) << "x";
  const Outcome r = run("run " + example("pendulum") + " --out " + (file / "below").string());
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("not a folder"), std::string::npos) << r.err;
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

TEST_F(CommandLine, AFailingBoundaryValueIsTyped) {
  const Outcome r =
      run("run " + example("plate_ball") +
          " --set parameters.rotation=trace --set time.steps=3 --set boundary.end.position=[100,0] --json");
  EXPECT_EQ(r.code, 3) << r.err;
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_NE(json.at("status"), "converged");
  EXPECT_NE(json.at("message").get<std::string>().find("best residual"), std::string::npos);
}

TEST_F(CommandLine, TheLedgerSpeaksOfTheSolve) {
  const Outcome failed =
      run("run " + example("plate_ball") + " --set solver.starts=2 --set boundary.end.position=[1e6,0]");
  EXPECT_EQ(failed.code, 3);
  EXPECT_NE(failed.out.find("not every equation solved, status stagnated: BROKEN"), std::string::npos) << failed.out;
  EXPECT_NE(run("run " + example("pendulum")).out.find(" every equation solved, status converged: kept"),
            std::string::npos);
}

TEST_F(CommandLine, FilesThatCannotBeWrittenDoNotBreakTheSolve) {
  const fs::path out = folder_ / "full";
  fs::create_directories(out);
  // Files may have four thousand bytes: the trajectory does not fit.
  const Outcome r = run("run " + example("pendulum") + " --json --out " + out.string(), "trap '' XFSZ; ulimit -f 8; ");
  EXPECT_EQ(r.code, 3);
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_EQ(json.at("status"), "output_failed");
  EXPECT_FALSE(json.at("message").get<std::string>().empty());
  EXPECT_EQ(json.at("ledger").at("solver").at("status"), "converged");
  EXPECT_EQ(json.at("ledger").at("solver").at("verdict"), "kept");
  for (const auto& entry : fs::directory_iterator(out)) {
    const std::string name = entry.path().filename();
    EXPECT_TRUE(name == "checkpoint" || name == ".lagroid") << name;
  }
}

TEST_F(CommandLine, AFolderThatTakesNoFilesIsRefusedBeforeRunning) {
  const fs::path out = folder_ / "taken";
  fs::create_directories(out / "trajectory.h5");
  const Outcome taken = run("run " + example("pendulum") + " --out " + out.string());
  EXPECT_EQ(taken.code, 2);
  EXPECT_NE(taken.err.find("trajectory.h5 is a folder"), std::string::npos) << taken.err;
  EXPECT_NE(taken.err.find("choose another place"), std::string::npos) << taken.err;
  const Outcome proc = run("run " + example("pendulum") + " --out /proc/foo");
  EXPECT_EQ(proc.code, 2);
  EXPECT_NE(proc.err.find("/proc/foo"), std::string::npos) << proc.err;
  EXPECT_NE(proc.err.find("choose another place"), std::string::npos) << proc.err;
}

TEST_F(CommandLine, StagingsOfKilledRunsAreRemoved) {
  const fs::path out = folder_ / "stale";
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  const fs::path dead = out / (".partial-" + std::to_string(child));
  const fs::path alive = out / (".partial-" + std::to_string(::getpid()));
  const fs::path foreign = out / ".partial-results";
  for (const auto& folder : {dead, alive, foreign}) fs::create_directories(folder);
  std::ofstream(dead / "trajectory.csv") << "half";
  EXPECT_EQ(run("run " + example("pendulum") + " --set time.steps=3 --out " + out.string()).code, 0);
  EXPECT_FALSE(fs::exists(dead));
  EXPECT_TRUE(fs::exists(alive));
  EXPECT_TRUE(fs::exists(foreign));
}

TEST_F(CommandLine, AFullStandardOutputIsSaid) {
  for (const std::string& arguments :
       std::vector<std::string>{"run " + example("pendulum"), "run " + example("pendulum") + " --json", "list"}) {
    const Outcome r = run(arguments + " >/dev/full");
    EXPECT_EQ(r.code, 3) << arguments;
    EXPECT_EQ(r.err, "lagroid: standard output could not be written\n");
  }
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

TEST_F(CommandLine, WhereAContinuationCannotBeginItsFromIsBlamed) {
  const std::string scene = "run " + example("plate_ball_continuation") + " --set continuation.parameter=";
  for (const std::string& arguments : std::vector<std::string>{
           "time.duration --set continuation.from=0", "parameters.spin --set continuation.from=1000",
           "boundary.end.attitude --set boundary.end.attitude=[1,0,0,0] --set continuation.from=[1,1,0,0]"}) {
    const Outcome r = run(scene + arguments);
    EXPECT_EQ(r.code, 2) << arguments;
    EXPECT_EQ(r.err.rfind("lagroid: --set continuation.from: at ", 0), 0U) << r.err;
  }
}

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
