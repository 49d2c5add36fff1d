// The page on the mathematics names every law, what fails it, and what nightly tests alone bear.
#include "pages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace lagroid::documentation_tests::mathematics_tests {
namespace {

TEST(Mathematics, WhatItNamesExists) { EXPECT_EQ(unknown_names(read("docs/mathematics.md")), none); }

TEST(Mathematics, ItNamesEveryLaw) {
  // It and the pages of what is not [G]'s.
  const auto named =
      matches(read("docs/mathematics.md") + read("docs/nonholonomic.md") + read("docs/time.md") +
                  read("docs/higher_order.md") + read("docs/multibody.md") + read("docs/lie_group_integrators.md") +
                  read("docs/extrapolation.md") + read("docs/ensembles.md") + read("docs/poisson.md") +
                  read("docs/any_lagrangian.md") + prose_of(read("docs/optimisation.md")) +
                  prose_of(read("docs/optimal_control.md")) + prose_of(read("docs/learning.md")),
              "\"([^\"]+)\"");
  const auto laws =
      matches(text_of({"core/testing", "solvers/testing", "solvers/optimisation/testing", "solvers/galerkin/testing",
                       "solvers/learning/testing", "systems/multibody/testing", "systems/testing"},
                      ".hpp"),
              "law\\( ?\"([^\"]+)\",");
  EXPECT_GT(laws.size(), 50U);
  for (const auto& law : laws) EXPECT_NE(std::find(named.begin(), named.end(), law), named.end()) << law;
}

TEST(Mathematics, WhatFailsALawSaysWhich) { EXPECT_EQ(unfounded_failures(read("docs/mathematics.md")), none); }

TEST(Mathematics, ThePageOnPoissonManifoldsNamesWhatThereIs) {
  const std::string page = read("docs/poisson.md");
  EXPECT_EQ(unknown_names(page), none);
  EXPECT_EQ(unfounded_failures(page), none);
}

/// The files in tests/ that only the nightly tests build.
std::vector<std::string> nightly_files() {
  const std::string list =
      matches(read("tests/CMakeLists.txt"), "foreach\\(name (groupoids/laws_algebroid [^)]*)\\)").at(0);
  std::vector<std::string> out{"certificates", "nightly_runs"};
  for (const auto& name : matches(list, "(\\w+)(?: |$)")) out.push_back(name);
  return out;
}

/// What the page names and nightly tests alone bear, but for what its section on them says, and the other way round:
/// suites of tests, and law suites that no other test calls.
std::vector<std::string> misplaced_on(const std::string& page) {
  const std::string told = section(page, "## What is tested when");
  std::string daily;
  const auto files = nightly_files();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "tests")) {
    const bool at_night = std::find(files.begin(), files.end(), entry.path().stem()) != files.end();
    if (entry.path().extension() == ".cpp" && !at_night) daily += read(entry.path());
  }
  std::vector<std::string> out;
  const auto compare = [&](const std::string& name, bool at_night) {
    if (has_word(told, name) != at_night) out.push_back(name);
  };
  for (const auto& test : matches(page, "`([A-Z]\\w+\\.[A-Z]\\w+)`"))
    compare(test.substr(0, test.find('.')), body_of(test, daily).empty());
  for (const auto& suite : matches(page, "`(\\w+_laws?)`"))
    compare(suite, daily.find("laws::" + suite) == std::string::npos);
  return out;
}

TEST(Mathematics, SaysWhatTheNightlyTestsAloneBear) { EXPECT_EQ(misplaced_on(read("docs/mathematics.md")), none); }

TEST(BrokenPage, AClaimThatNightlyTestsAloneBearIsFoundOut) {
  std::string page = read("docs/mathematics.md");
  const std::string named = "PoissonDefect, ";
  page.erase(page.find(named), named.size());
  page.replace(page.find("`cotangent_laws`"), 16, "`variational_laws`");
  const auto found = misplaced_on(page);
  for (const char* name : {"PoissonDefect", "cotangent_laws", "variational_laws"})
    EXPECT_NE(std::find(found.begin(), found.end(), name), found.end()) << name;
}

}  // namespace
}  // namespace lagroid::documentation_tests::mathematics_tests
