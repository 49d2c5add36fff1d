// Scenes of Poisson systems on the command line: ledgers, methods, what is refused and in which words.
#include "../command_line.hpp"

#include <nlohmann/json.hpp>

#include <string>

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

}  // namespace
