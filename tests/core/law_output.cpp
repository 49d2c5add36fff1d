// Law suites speak on standard error of what fails, and of nothing else.
#include <lagroid/core/testing/property.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

using namespace lagroid;

namespace core_law_output_tests {
namespace {

std::string said(const std::function<double()>& defect) {
  ::testing::internal::CaptureStderr();
  laws::check_law("numbers are small", 0.5, defect);
  return ::testing::internal::GetCapturedStderr();
}

TEST(CheckLaw, IsSilentWhereTheLawHolds) {
  EXPECT_EQ(said([] { return 0.25 * std::abs(laws::draw_uniform()); }), "");
}

TEST(CheckLaw, SaysWhatFailsAndHowToSeeItAgain) {
  const std::string failure = said([] { return std::abs(laws::draw_uniform()); });
  EXPECT_NE(failure.find("- numbers are small\n"), std::string::npos) << failure;
  EXPECT_NE(failure.find("Falsifiable"), std::string::npos) << failure;
  const std::string environment = "\nRC_PARAMS=\"";
  const auto at = failure.find(environment);
  ASSERT_NE(at, std::string::npos) << failure;
  const auto from = at + environment.size();
  const std::string parameters = failure.substr(from, failure.find('"', from) - from);
  EXPECT_NE(parameters.find("reproduce="), std::string::npos) << parameters;
  // With these parameters nothing is drawn but the sample that failed.
  laws::fix_seed();
  const std::string before = std::getenv("RC_PARAMS");
  ::setenv("RC_PARAMS", parameters.c_str(), 1);
  ::testing::internal::CaptureStderr();
  const auto again = laws::check_law("numbers are small", 0.5, [] { return std::abs(laws::draw_uniform()); });
  ::testing::internal::GetCapturedStderr();
  ::setenv("RC_PARAMS", before.c_str(), 1);
  EXPECT_FALSE(again.holds());
  EXPECT_LE(again.samples, 2);
}

TEST(CheckLaw, SaysWhatWasThrown) {
  const std::string failure = said([]() -> double { throw std::runtime_error("step 3: stagnated"); });
  EXPECT_NE(failure.find("step 3: stagnated"), std::string::npos) << failure;
}

}  // namespace
}  // namespace core_law_output_tests
