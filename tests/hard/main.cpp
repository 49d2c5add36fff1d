// The hard cases as tests, and as the page that states what is supported.
//     hard [gtest options]        one test a case; compiled with LAGROID_HARD_NIGHTLY, the long cases instead
//     hard --page FILE            measures all but the long cases and writes docs/supported_envelope.md
#include "support/hard_case.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <string_view>

namespace lagroid::hard {
namespace {

const std::vector<Topic>& topics() {
  static const std::vector<Topic> all{
      {"Rotations", "Rotations and rigid motions", rotations},
      {"Spin", "Fast and unstable rotation", spin},
      {"Pendulums", "Pendulums near equilibria and poles", pendulums},
      {"Bodies", "Scenes of bodies: masses, springs, drag", bodies},
      {"Joints", "Scenes of bodies: dependent and singular joints", joints},
      {"Orbits", "Close approach to a centre", orbits},
      {"Steps", "Very large, very small and strange steps", steps},
      {"LongRuns", "Long runs", long_runs},
      {"PlateBall", "The rolling ball on a plate", plate_ball},
      {"BoundaryValues", "Boundary values", boundary_values},
      {"BadInput", "Input that is not finite", bad_input},
  };
  return all;
}

class HardTest : public ::testing::Test {
 public:
  explicit HardTest(HardCase hard) : hard_(std::move(hard)) {}
  void TestBody() override {
    const double defect = hard_.ours();
    EXPECT_TRUE(kept(hard_, defect)) << hard_.promise << ": " << defect << ", bound " << hard_.bound;
    const double broken = hard_.broken();
    EXPECT_TRUE(missed(hard_, broken)) << "not told apart from " << hard_.naive << ": " << broken << ", bound "
                                       << hard_.bound;
    RecordProperty("measured", fmt::format("{:.2e}", defect));
    RecordProperty("naive", fmt::format("{:.2e}", broken));
  }

 private:
  HardCase hard_;
};

/// Two digits; what is not finite in words.
std::string number(double x) {
  if (std::isnan(x)) return "NaN";
  if (std::isinf(x)) return "infinite";
  return x == 0 ? "0" : fmt::format("{:.1e}", x);
}

/// A text as a cell of a table, where | would end it.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? "\\|" : std::string(1, c);
  return out;
}

/// The page: the template with its tables in place of the line @TABLES@. Returns whether all bounds were kept; where
/// one is missed or the file cannot be written, leaves the file as it was and says so.
bool write_page(const std::string& file) {
  std::ifstream input(LAGROID_HARD_TEMPLATE);
  std::string text{std::istreambuf_iterator<char>(input), {}};
  if (!input) {
    std::cerr << "hard: cannot read " << LAGROID_HARD_TEMPLATE << '\n';
    return false;
  }
  std::ostringstream tables;
  bool good = true;
  int count = 0;
  for (const Topic& topic : topics()) {
    tables << "## " << topic.title << "\n\n"
           << "| regime | promise | bound | measured | the naive way | which gives | test |\n"
           << "|---|---|---|---|---|---|---|\n";
    for (const HardCase& hard : topic.cases()) {
      if (hard.nightly) {
        tables << fmt::format("| {} | {} | {} | nightly | {} | nightly | `Hard_{}.{}` |\n", cell(hard.regime),
                              cell(hard.promise), number(hard.bound), cell(hard.naive), topic.name, hard.name);
        ++count;
        continue;
      }
      const double defect = hard.ours();
      const double broken = hard.broken();
      if (!kept(hard, defect) || !missed(hard, broken)) {
        std::cerr << "Hard_" << topic.name << '.' << hard.name << ": " << defect << ", naive " << broken << ", bound "
                  << hard.bound << '\n';
        good = false;
      }
      tables << fmt::format("| {} | {} | {} | {} | {} | {} | `Hard_{}.{}` |\n", cell(hard.regime), cell(hard.promise),
                            number(hard.bound), number(defect), cell(hard.naive), number(broken), topic.name,
                            hard.name);
      ++count;
    }
    tables << '\n';
  }
  const auto replace = [&text](std::string_view what, std::string by) {
    while (by.ends_with('\n')) by.pop_back();
    const auto at = text.find(what);
    if (at != std::string::npos) text.replace(at, what.size(), by);
  };
  replace("@COUNT@", std::to_string(count));
  replace("@TABLES@", tables.str());
  if (!good) {
    std::cerr << "hard: " << file << " is left as it was\n";
    return false;
  }
  const std::string partial = file + ".partial";
  std::ofstream out(partial);
  out << text;
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(partial, file, error);
  if (!out || error) {
    std::filesystem::remove(partial, error);
    std::cerr << "hard: " << file << " could not be written\n";
    return false;
  }
  return true;
}

}  // namespace
}  // namespace lagroid::hard

int main(int argc, char** argv) {
  using namespace lagroid::hard;
  if (argc == 3 && std::string_view(argv[1]) == "--page") return write_page(argv[2]) ? 0 : 1;
  ::testing::InitGoogleTest(&argc, argv);
#ifdef LAGROID_HARD_NIGHTLY
  constexpr bool nightly = true;
#else
  constexpr bool nightly = false;
#endif
  for (const Topic& topic : topics())
    for (const HardCase& hard : topic.cases())
      if (hard.nightly == nightly)
        ::testing::RegisterTest(("Hard_" + topic.name).c_str(), hard.name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                                [hard]() -> ::testing::Test* { return new HardTest(hard); });
  return RUN_ALL_TESTS();
}
