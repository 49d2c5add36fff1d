// The files of a run: whole, or not there; what cannot be written is refused.
#include "../command_line.hpp"

#include <H5Cpp.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <string>
#include <vector>

namespace command_line_files_tests {
namespace {

TEST_F(CommandLine, APipeThatNobodyReadsIsAnErrorAndLeavesNoLock) {
  const std::string out = (folder_ / "piped").string();
  run("run " + example("kepler") + " --set time.steps=5 --out " + out + " | true");
  EXPECT_TRUE(fs::exists(out + "/summary.json"));
  EXPECT_FALSE(fs::exists(out + "/.lock"));
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

}  // namespace
}  // namespace command_line_files_tests
