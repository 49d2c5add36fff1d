// What `lagroid run` computes and reports of boundary values.
#include "../command_line.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <string>
#include <vector>

namespace command_line_boundary_values_tests {
namespace {

TEST_F(CommandLine, BoundaryValueJson) {
  const Outcome r = run("run " + example("plate_ball") + " --json");
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_NEAR(json.at("cost").get<double>(), 7.2978550783250329880, 1e-11);
  EXPECT_EQ(json.at("stationary_paths").at(0).at("is_minimum"), true);
  EXPECT_EQ(json.at("stationary_paths").at(0).at("momentum").size(), 5U);
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
           "run " + example("kepler_boundary") + " --set solver.stationary_kind=maxima",
           "run " + example("kepler_boundary") + " --set solver.seek=maxima",
           "run " + example("kepler_boundary") + " --set solver.seek=minima --set solver.stationary_kind=minima",
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

TEST_F(CommandLine, TheOldNameOfTheStationaryKindIsReadAndTold) {
  const auto found = [this](const std::string& key) {
    const Outcome r = run("run " + example("kepler_boundary") + " --json --set solver.starts=6 --set solver." + key);
    EXPECT_EQ(r.code, 0) << r.err;
    return nlohmann::json::parse(r.out);
  };
  const auto now = found("stationary_kind=stationary");
  const auto before = found("seek=stationary");
  EXPECT_EQ(before.at("cost"), now.at("cost"));
  EXPECT_NE(before.at("notes").dump().find("solver.seek is solver.stationary_kind now"), std::string::npos);
  EXPECT_EQ(now.at("notes").dump().find("seek"), std::string::npos);
  EXPECT_NE(found("stationary_kind=minima").at("notes"), now.at("notes"));
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

}  // namespace
}  // namespace command_line_boundary_values_tests
