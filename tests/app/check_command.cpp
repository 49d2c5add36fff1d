// `lagroid check`: what is certified, what is not, and what is said.
#include "command_line.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace app_check_command_tests {
namespace {

constexpr std::array at_once{"pendulum_chain",    "learned_hamiltonian", "lotka_volterra", "three_species",
                             "volterra_ring",     "euler_top",           "kirchhoff",      "toda",
                             "toda_ring",         "maxwell_bloch",       "sklyanin",       "magnetic_particle",
                             "heavy_top_bracket", "body_in_space",       "spin_chain",     "lagrangian",
                             "hamiltonian"};

TEST_F(CommandLine, EveryExampleIsCertified) {
  for (const auto& entry : fs::directory_iterator(LAGROID_EXAMPLES)) {
    if (entry.path().extension() != ".toml") continue;
    const Outcome r = run("check " + entry.path().string() + " --samples 10 --json");
    EXPECT_EQ(r.code, 0) << entry.path() << r.err << r.out;
    const auto json = nlohmann::json::parse(r.out);
    EXPECT_EQ(json.at("status"), "certified");
    // The step of a scene of bodies is asked where it starts.
    std::ifstream file(entry.path());
    const std::string text(std::istreambuf_iterator<char>(file), {});
    const int samples = text.find("[[body]]") == std::string::npos ? 10 : 1;
    // Orders and loops of integrators on spheres, on Poisson manifolds and of formulas are asked once.
    const bool once = std::any_of(at_once.begin(), at_once.end(), [&](const std::string& name) {
      return text.find('"' + name + '"') != std::string::npos;
    });
    for (const auto& suite : json.at("suites"))
      for (const auto& law : suite.at("laws"))
        EXPECT_TRUE(law.at("samples") == samples || (once && law.at("samples") == 1)) << law;
  }
}

TEST_F(CommandLine, ACertificateIsWithheldFromALawThatIsBroken) {
  // A fall into the centre, through positions where derivatives have no digits left.
  const std::string scene = "check " + example("kepler") + " --samples 20 --set initial.position=[1e-9,0]";
  const Outcome r = run(scene);
  EXPECT_EQ(r.code, 3) << r.out;
  EXPECT_NE(r.out.find("BROKEN"), std::string::npos) << r.out;
  EXPECT_NE(r.out.find("NOT certified"), std::string::npos) << r.out;
  EXPECT_EQ(nlohmann::json::parse(run(scene + " --json").out).at("status"), "broken");
}

TEST_F(CommandLine, ReductionsAreExaminedAndTheOneOfTheSceneHasItsLaws) {
  const auto of = [&](const std::string& scene) {
    const Outcome r = run("check " + scene + " --samples 10 --json");
    EXPECT_EQ(r.code, 0) << scene << r.out;
    return nlohmann::json::parse(r.out);
  };
  const auto reduced_suites = [](const nlohmann::json& certificate) {
    const auto& suites = certificate.at("suites");
    return std::count_if(suites.begin(), suites.end(), [](const auto& suite) {
      return suite.at("suite").template get<std::string>().starts_with("reduced: ");
    });
  };
  const auto full = of(example("kepler"));
  EXPECT_EQ(full.at("reductions").size(), 2u);
  EXPECT_EQ(full.at("reductions").at(0).at("descends"), true);
  EXPECT_EQ(reduced_suites(full), 0);
  EXPECT_GT(reduced_suites(of(example("kepler") + " --set reduce=rotations")), 0);
  for (const auto& [scene, by] : {std::pair("kepler", "angular-momentum"), std::pair("gyrostat", "rotor-momenta"),
                                  std::pair("heavy_top", "vertical-momentum")})
    EXPECT_GT(reduced_suites(of(example(scene) + " --set reduce=" + by)), 0) << scene;
  // A plate that turns is not invariant under translations: said, but no law of the scene.
  const auto turning = of(example("plate_ball_initial_value")).at("reductions").at(0);
  EXPECT_EQ(turning.at("descends"), false);
  EXPECT_NE(turning.at("message").get<std::string>().find("constraint"), std::string::npos) << turning;
}

TEST_F(CommandLine, StatesWithoutAStepArePassedOver) {
  // Half turns in one step: the run goes through, steps from some states beside it do not.
  const Outcome r = run("check " + example("rigid_body") + " --samples 20 --json --set time.step=3");
  EXPECT_EQ(r.code, 0) << r.out;
  bool skipped = false;
  const auto json = nlohmann::json::parse(r.out);
  for (const auto& suite : json.at("suites"))
    for (const auto& law : suite.at("laws")) skipped = skipped || law.at("skipped") > 0;
  EXPECT_TRUE(skipped);
}

TEST_F(CommandLine, SystemsAtRestInOtherUnitsAndWithTinyStepsAreCertified) {
  for (const std::string& scene : std::vector<std::string>{
           example("pendulum") + " --set initial.position=[0] --set initial.momentum=[0]",
           example("rigid_body") + " --set initial.momentum=[0,0,0]", example("heavy_top") + " --set time.steps=1",
           example("pendulum") + " --set time.step=1e-5", example("rigid_body") + " --set time.step=1e-6",
           example("plate_ball_initial_value") + " --set time.step=1e-3",
           example("kepler") + " --set parameters.strength=3.986e14 --set initial.position=[7e6,0] --set "
                               "initial.momentum=[0,7500] --set time.step=10",
           example("pendulum_chain") +
               " --set initial.theta=3.141592653589793 --set initial.angular_velocities=[0,0,0]",
           example("pendulum_chain") + " --set time.step=1e-5",
           example("pendulum_chain") +
               " --set time.step=0.01 --set time.form=momenta --set parameters.masses=[1,1,1e-6]"}) {
    const Outcome r = run("check " + scene + " --samples 20");
    EXPECT_EQ(r.code, 0) << scene << r.out << r.err;
  }
}

TEST_F(CommandLine, WhereTheRunFailsTheGroupoidAloneIsTested) {
  const Outcome r = run("check " + example("spherical_pendulum") + " --json --set time.step=2");
  EXPECT_EQ(r.code, 3) << r.out;
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_EQ(json.at("status"), "not_converged") << r.out;
  EXPECT_NE(json.at("message").get<std::string>().find("step 1"), std::string::npos) << r.out;
  EXPECT_EQ(json.at("suites").size(), 3U);
  for (const auto& suite : json.at("suites")) EXPECT_TRUE(suite.at("holds")) << suite;
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
}

TEST_F(CommandLine, ASceneWithATargetErrorIsCertified) {
  const Outcome r =
      run("check " + example("pendulum") + " --json --samples 20 --set accuracy.target=1e-4 --set accuracy.pilot=0.3");
  EXPECT_EQ(r.code, 0) << r.out << r.err;
}

TEST_F(CommandLine, SolutionsOfOptimalControlAreCertified) {
  for (const char* name : {"swing_up", "shortest_way", "reeds_shepp", "keep_out"}) {
    const Outcome r = run("check " + example(std::string("control/") + name) + " --set horizon.stages=40 --json");
    EXPECT_EQ(r.code, 0) << name << r.err << r.out;
    const auto suites = nlohmann::json::parse(r.out).at("suites");
    ASSERT_EQ(suites.size(), 2U) << name;
    const auto& laws = suites.at(1).at("laws");
    const auto has = [&](const std::string& law) {
      return std::any_of(laws.begin(), laws.end(), [&](const auto& each) { return each.at("law") == law; });
    };
    EXPECT_TRUE(has("the KKT residual vanishes")) << name;
    EXPECT_TRUE(has("complementarity")) << name;
    EXPECT_TRUE(has("the cost is of order two in the step") || has("the cost is of order two in envelope")) << name;
  }
  for (const char* set : {"", " --set 'boundary.end_cost=\"angle^2\"'"}) {
    const Outcome gate = run("check " + example("control/through_a_gate") + set);
    EXPECT_EQ(gate.code, 0) << set << gate.out << gate.err;
  }
  const Outcome none = run("check " + example("control/fastest_stop") +
                           " --set horizon.free=false --set horizon.duration=1 --set solver.starts=1");
  EXPECT_EQ(none.code, 3);
  EXPECT_NE(none.err.find("relax the constraints"), std::string::npos) << none.err;
}

TEST_F(CommandLine, CheckRefusesWhatRunRefuses) {
  const Outcome unknown = run("check " + example("pendulum") + " --set parameters.colour=1 --json");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_EQ(nlohmann::json::parse(unknown.out).at("status"), "invalid_scene");
  const Outcome samples = run("check " + example("pendulum") + " --samples 0");
  EXPECT_EQ(samples.code, 2);
  EXPECT_NE(samples.err.find("--samples"), std::string::npos) << samples.err;
  EXPECT_NE(run("check --help").out.find("--samples"), std::string::npos);
}

}  // namespace
}  // namespace app_check_command_tests
