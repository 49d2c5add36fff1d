// The tables of `lagroid bench`: which subjects a part of a name picks, and what becomes of goals without a
// measurement.
#include "comparison.hpp"

#include <gtest/gtest.h>

namespace bench {

namespace {

TEST(Matching, TakesThePartAsPlainText) {
  const std::vector<Subject> subjects{{"SO(3), h = 0.01", "by hand", {}}, {"Kepler", "framework", {}}};
  EXPECT_EQ(matching(subjects, "").size(), 2U);
  EXPECT_EQ(matching(subjects, "SO(3)").size(), 1U);
  EXPECT_EQ(matching(subjects, "Kepler: framework").size(), 1U);
  EXPECT_TRUE(matching(subjects, "so(3)").empty());
  EXPECT_TRUE(matching(subjects, "[").empty());
  EXPECT_TRUE(matching(subjects, "Kep.*").empty());
}

TEST(Goals, OneWhoseSubjectFailedStaysInTheWholeTable) {
  const std::vector<Goal> goals{{"Kepler", "framework", "by hand", 2}, {"SO(3)", "framework", "by hand", 2}};
  const Results results{
      {"Kepler: framework", {3, 0, 0}}, {"Kepler: by hand", {1, 0, 0}}, {"SO(3): by hand", {1, 0, 0}}};
  const std::string whole = goals_table(goals, results, /*every=*/true);
  EXPECT_NE(whole.find("| Kepler: framework / by hand | 3 | at most 2 | **missed** |"), std::string::npos) << whole;
  EXPECT_NE(whole.find("| SO(3): framework / by hand |  | at most 2 | **not measured** |"), std::string::npos) << whole;
  EXPECT_EQ(goals_table(goals, results, /*every=*/false).find("SO(3)"), std::string::npos);
}

}  // namespace

}  // namespace bench
