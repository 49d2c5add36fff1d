// The pages keep up with the code: their C++ is that of the examples, what they quote is printed, what they name
// exists.
#include "pages.hpp"

#include <lagroid/core/version.hpp>

#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

namespace lagroid::documentation_tests::pages_tests {
namespace {

/// The text without the indentation of its lines.
std::string flush_left(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find_first_not_of(' ');
    out += (first == std::string::npos ? "" : line.substr(first)) + '\n';
  }
  return out;
}

/// The page's blocks in that language which are no part of `source`, indentation aside; one "no block" if it has none.
std::vector<std::string> foreign_blocks(const std::string& page, const std::string& language,
                                        const std::string& source) {
  const std::string fence = "```" + language + "\n";
  std::vector<std::string> out;
  if (page.find(fence) == std::string::npos) out.push_back("no block");
  for (auto at = page.find(fence); at != std::string::npos; at = page.find(fence, at)) {
    at += fence.size();
    const std::string block = page.substr(at, page.find("```", at) - at);
    if (flush_left(source).find(flush_left(block)) == std::string::npos) out.push_back(block);
    at += block.size() + 3;
  }
  return out;
}

TEST(Readme, ItsOwnSystemIsThatOfTheExample) {
  EXPECT_EQ(
      foreign_blocks(section(read("README.md"), "## A system of your own"), "cpp", read("examples/my_system.cpp")),
      none);
}

TEST(Tutorial, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/tutorial.md"), "cpp", read("examples/my_system.cpp")), none);
}

#ifdef LAGROID_EXAMPLE
TEST(Tutorial, WhatItQuotesIsPrinted) {
  std::FILE* pipe = ::popen(LAGROID_EXAMPLE " 2>/dev/null", "r");
  ASSERT_NE(pipe, nullptr);
  std::string printed;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) printed += char(c);
  EXPECT_EQ(::pclose(pipe), 0);
  EXPECT_EQ(foreign_blocks(read("docs/tutorial.md"), "text", printed), none);
}
#endif

TEST(BrokenPage, AnAlteredBlockIsFoundOut) {
  std::string page = read("docs/tutorial.md");
  const std::string half = "(0.5 / h)";
  page.replace(page.find(half), half.size(), "(0.6 / h)");
  EXPECT_EQ(foreign_blocks(page, "cpp", read("examples/my_system.cpp")).size(), 1U);
  EXPECT_EQ(foreign_blocks("no code", "cpp", "any").size(), 1U);
}

TEST(HigherOrder, WhatItNamesExists) { EXPECT_EQ(unknown_names(prose_of(read("docs/higher_order.md"))), none); }

TEST(AnyLagrangianPage, WhatItNamesExists) { EXPECT_EQ(unknown_names(prose_of(read("docs/any_lagrangian.md"))), none); }
TEST(AnyLagrangianPage, WhatFailsALawSaysWhich) {
  EXPECT_EQ(unfounded_failures(prose_of(read("docs/any_lagrangian.md"))), none);
}

TEST(HigherOrder, WhatFailsALawSaysWhich) { EXPECT_EQ(unfounded_failures(read("docs/higher_order.md")), none); }

TEST(HamiltonianMapsPage, WhatItNamesExists) {
  EXPECT_EQ(unknown_names(prose_of(read("docs/hamiltonian_maps.md"))), none);
}

TEST(HamiltonianMapsPage, ItsCodeIsThatOfTheTest) {
  EXPECT_EQ(foreign_blocks(read("docs/hamiltonian_maps.md"), "cpp", read("tests/solvers/hamiltonian_maps/maps.cpp")),
            none);
}

TEST(OptimisationPage, WhatItNamesExists) {
  const std::string page = read("docs/optimisation.md");
  for (const char* heading : {"## A function of your own", "## Algorithm 1, and what its multipliers are",
                              "## What is promised", "## The setting that we recommend"})
    EXPECT_EQ(unknown_names(prose_of(section(page, heading))), none) << heading;
}

TEST(OptimisationPage, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/optimisation.md"), "cpp", read("examples/my_objective.cpp")), none);
}

TEST(LieGroupPage, WhatItNamesExists) {
  EXPECT_EQ(unknown_names(prose_of(read("docs/lie_group_integrators.md"))), none);
}

TEST(ExtrapolationPage, WhatItNamesExists) { EXPECT_EQ(unknown_names(prose_of(read("docs/extrapolation.md"))), none); }

TEST(LieGroupPage, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/lie_group_integrators.md"), "cpp", read("examples/my_hamiltonian.cpp")), none);
}

TEST(LearningPage, WhatItNamesExists) {
  for (const char* heading : {"## How well", "## A potential of your own", "## Any Hamiltonian", "## Dissipation"})
    EXPECT_EQ(unknown_names(prose_of(section(read("docs/learning.md"), heading))), none) << heading;
}

TEST(LearningPage, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/learning.md"), "cpp",
                           read("examples/my_potential.cpp") + read("examples/my_learned_hamiltonian.cpp")),
            none);
}

TEST(Newton, WhatItNamesExists) { EXPECT_EQ(unknown_names(prose_of(read("docs/newton.md"))), none); }

TEST(Newton, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/newton.md"), "cpp", read("examples/implicit_step.cpp")), none);
}

TEST(Nonholonomic, WhatItNamesExists) { EXPECT_EQ(unknown_names(prose_of(read("docs/nonholonomic.md"))), none); }

TEST(Nonholonomic, WhatFailsALawSaysWhich) { EXPECT_EQ(unfounded_failures(read("docs/nonholonomic.md")), none); }

TEST(MultibodyPage, WhatItNamesExists) { EXPECT_EQ(unknown_names(prose_of(read("docs/multibody.md"))), none); }

TEST(MultibodyPage, WhatFailsALawSaysWhich) {
  EXPECT_EQ(unfounded_failures(prose_of(read("docs/multibody.md"))), none);
}

TEST(Ensembles, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/ensembles.md"), "cpp", read("examples/my_ensemble.cpp")), none);
  EXPECT_EQ(unknown_names(prose_of(read("docs/ensembles.md"))), none);
}

TEST(MultibodyPage, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/multibody.md"), "cpp", read("examples/my_effect.cpp")), none);
}

TEST(Sweeps, WhatItNamesExists) {
  const std::string page = read("docs/sweeps.md");
  const auto laws = matches(page, "`((?:Sweep|Schedule)\\.[A-Za-z]+)`");
  EXPECT_FALSE(laws.empty());
  const std::string tests = text_of({"tests/app/sweep_command"}, ".cpp");
  for (const std::string& law : laws) {
    const auto dot = law.find('.');
    EXPECT_NE(tests.find("(" + law.substr(0, dot) + ", " + law.substr(dot + 1) + ")"), std::string::npos) << law;
  }
}

TEST(Time, WhatItNamesExists) { EXPECT_EQ(unknown_names(prose_of(read("docs/time.md"))), none); }

TEST(Time, WhatFailsALawSaysWhich) { EXPECT_EQ(unfounded_failures(prose_of(read("docs/time.md"))), none); }

TEST(TheoryPages, WhatTheyNameExists) {
  for (const char* paper : {"G", "N", "V", "H", "lagrange_poincare"})
    EXPECT_EQ(unknown_names(prose_of(read(std::string("docs/theory/") + paper + ".md"))), none) << paper;
}

/// What looks like the name of a test, Suite.Name, in `backquotes`.
std::vector<std::string> unknown_tests(const std::string& page) {
  const std::string tests = text_of({"tests"}, ".cpp");
  std::vector<std::string> out;
  for (const auto& name : matches(prose_of(page), "`([A-Z]\\w+\\.[A-Z]\\w+)`"))
    if (body_of(name, tests).empty()) out.push_back(name);
  return out;
}

TEST(Questions, AreAnsweredByTestsThatExist) {
  const std::string page = read("docs/faq.md");
  EXPECT_EQ(unknown_tests(page), none);
  for (auto at = page.find("\n## "); at != std::string::npos; at = page.find("\n## ", at + 1)) {
    const std::string answer = page.substr(at, page.find("\n## ", at + 1) - at);
    EXPECT_FALSE(matches(answer, "`([A-Z]\\w+\\.[A-Z]\\w+)`").empty()) << answer.substr(0, 80);
  }
}

TEST(BrokenPage, ATestOfNothingIsFoundOut) {
  EXPECT_EQ(unknown_tests("`Nothing.IsTested`, `NewtonStep.ReportsNotFinite`"),
            std::vector<std::string>{"Nothing.IsTested"});
}

TEST(StabilityPage, WhatItNamesExists) {
  const std::string page = read("docs/stability.md");
  for (const char* heading : {"## Stable", "## Experimental"})
    EXPECT_EQ(unknown_names(section(page, heading)), none) << heading;
}

TEST(InstallPage, TheVersionIsThatOfTheLibrary) {
  EXPECT_NE(read("pyproject.toml").find("\ndynamic = [\"version\"]\n"), std::string::npos);
  EXPECT_NE(read("CHANGELOG.md").find("\n## " LAGROID_VERSION), std::string::npos);
}

TEST(InstallPage, TheFilesItNamesExist) {
  const auto names = matches(prose_of(read("docs/install.md")), "`((?:app|bench|core|docs|tests)/[^` ]+)`");
  EXPECT_GT(names.size(), 3U);
  for (const auto& name : names) EXPECT_TRUE(exists(root / name)) << name;
}

TEST(BrokenPage, AFailureOfAnotherLawIsFoundOut) {
  const std::vector<std::string> unfounded{"units", "BrokenGroupoid.WrongInverse"};
  EXPECT_EQ(unfounded_failures("\"units\"\n- Fails: `BrokenGroupoid.WrongInverse`.\n\n"
                               "\"units\", fails: `BrokenGroupoid.WrongUnit`"),
            unfounded);
}

TEST(BrokenPage, ANameOfNothingIsFoundOut) {
  const std::vector<std::string> names{"core/nothing.hpp", "Nothing.IsTested", "nothing_at_all", "no law"};
  EXPECT_EQ(unknown_names("`core/nothing.hpp` `Nothing.IsTested` `nothing_at_all` \"no law\""), names);
}

}  // namespace
}  // namespace lagroid::documentation_tests::pages_tests
