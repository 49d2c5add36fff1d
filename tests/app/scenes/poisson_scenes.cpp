// Scenes of Poisson systems on the command line: ledgers, methods, what is refused and in which words.
#include "../command_line.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <string>

namespace scenes_poisson_scenes_tests {
namespace {

TEST_F(CommandLine, PoissonScenesKeepWhatTheirMethodsPromise) {
  for (const char* name : {"lotka_volterra", "three_species", "toda_ring", "sklyanin"}) {
    const Outcome r = run("run " + example(name) + " --json --set time.steps=200");
    ASSERT_EQ(r.code, 0) << r.err;
    const auto json = nlohmann::json::parse(r.out);
    EXPECT_EQ(json.at("status"), "converged") << name;
    EXPECT_EQ(r.out.find("BROKEN"), std::string::npos) << r.out;
    EXPECT_NE(r.out.find("Poisson defect"), std::string::npos) << name;
  }
  const Outcome midpoint = run("run " + example("three_species") + " --set time.method=midpoint --set time.steps=50");
  EXPECT_EQ(midpoint.code, 0) << midpoint.err;
  EXPECT_NE(midpoint.out.find("the bracket is kept up to h^3 in a step"), std::string::npos) << midpoint.out;
}

TEST_F(CommandLine, PoissonScenesThatCannotBeAreRefusedInOneLine) {
  const auto refused = [&](const std::string& settings, const std::string& words) {
    const Outcome r = run("run " + example("lotka_volterra") + " " + settings);
    EXPECT_EQ(r.code, 2) << settings << r.out;
    EXPECT_NE(r.err.find(words), std::string::npos) << r.err;
  };
  refused("--set initial.state=[-1,1]", "outside of where bracket and energy are smooth");
  refused("--set initial.state=[1,1,1]", "initial.state");
  refused("--set time.method=hamilton-jacobi-4 --set time.composition=suzuki", "is of steps of order two");
  refused("--set time.method=projected-midpoint", "time.method");
  const Outcome far =
      run("run " + example("lotka_volterra") + " --set time.method=karasev --set time.step=40 --set time.steps=3");
  EXPECT_EQ(far.code, 3);
  EXPECT_NE(far.err.find("left the domain"), std::string::npos) << far.err;
}

TEST_F(CommandLine, NoiseKeepsCasimirsAndPromisesNoEnergy) {
  const auto ledger = [&](const std::string& settings) {
    const Outcome r = run("run " + example("stochastic_top") + " --json --set time.steps=400 " + settings);
    EXPECT_EQ(r.code, 0) << r.err;
    auto json = nlohmann::json::parse(r.out);
    json.erase("seconds");
    return json.dump();
  };
  const std::string damped = ledger("");
  EXPECT_EQ(damped.find("BROKEN"), std::string::npos) << damped;
  EXPECT_NE(damped.find("noise along M1 (0.3), M2 (0.3), M3 (0.3), path 0 of seed 1"), std::string::npos) << damped;
  EXPECT_NE(damped.find("friction for the temperature 0.5"), std::string::npos) << damped;
  EXPECT_NE(damped.find("the bracket is kept up to h in a step, Casimirs exactly"), std::string::npos) << damped;
  EXPECT_EQ(damped, ledger(""));
  EXPECT_NE(damped, ledger("--set noise.path=1"));
  EXPECT_NE(damped, ledger("--set noise.seed=2"));
  // Without friction each path is a Poisson map.
  const Outcome free = run("run " + example("lotka_volterra") + " --set time.steps=50 --set noise.strength.growth=0.1");
  EXPECT_EQ(free.code, 0) << free.err;
  EXPECT_NE(free.out.find("the bracket is kept exactly, Casimirs exactly"), std::string::npos) << free.out;
  EXPECT_EQ(free.out.find("BROKEN"), std::string::npos) << free.out;
}

TEST_F(CommandLine, NoiseThatCannotBeIsRefusedInOneLine) {
  const auto refused = [&](const std::string& command, const std::string& words) {
    const Outcome r = run(command);
    EXPECT_EQ(r.code, 2) << command << r.out;
    EXPECT_NE(r.err.find(words), std::string::npos) << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  };
  const std::string top = "run " + example("stochastic_top") + " ";
  refused(top + "--set noise.strength.M1=-0.1", "noise.strength.M1");
  refused(top + "--set noise.strength.M4=0.1", "unknown key");
  refused(top + "--set noise.temperature=0", "noise.temperature");
  refused(top + "--set noise.seed=0.5", "noise.seed");
  refused(top + "--set time.method=hamilton-jacobi-4", "does not go with [noise]");
  refused(top + "--set time.order=4", "are not composed");
  refused("run " + example("sklyanin") + " --set noise.seed=1", "has no noise Hamiltonians, along whose fields");
  refused("run " + example("lotka_volterra") + " --set noise.seed=1", "missing key \"strength\"");
  refused("study " + example("stochastic_top"), "no two of them have an error to compare");
}

TEST_F(CommandLine, ARunWithNoiseGoesOnWithTheSameBits) {
  const std::string whole = (folder_ / "whole").string();
  const std::string half = (folder_ / "half").string();
  const std::string scene = example("stochastic_top") + " --set output.every=1";
  ASSERT_EQ(run("run " + scene + " --set time.steps=200 --out " + whole).code, 0);
  ASSERT_EQ(run("run " + scene + " --set time.steps=100 --out " + half).code, 0);
  ASSERT_EQ(run("resume " + half + " --set time.steps=200").code, 0);
  const auto text = [](const std::string& folder) {
    std::ifstream in(folder + "/trajectory.csv");
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_FALSE(text(whole).empty());
  EXPECT_EQ(text(whole), text(half));
}

TEST_F(CommandLine, SweepsOverSeedsAreEnsembles) {
  const fs::path sweep = folder_ / "paths.toml";
  std::ofstream(sweep) << "[scene]\nfile = " << std::quoted(example("stochastic_top"))
                       << "\ntime.steps = 40\n[design]\nkind = \"grid\"\n[[vary]]\nkey = \"noise.seed\"\n"
                          "values = [1, 2, 3]\n[[vary]]\nkey = \"noise.path\"\nvalues = [0, 1]\n";
  const Outcome r = run("sweep " + sweep.string() + " --out " + (folder_ / "out").string() + " --json");
  ASSERT_EQ(r.code, 0) << r.err << r.out;
  EXPECT_EQ(nlohmann::json::parse(r.out).at("members"), 6) << r.out;
}

}  // namespace
}  // namespace scenes_poisson_scenes_tests
