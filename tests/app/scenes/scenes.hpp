#pragma once
/// Tests of scenes of bodies through the program.

#include "../command_line.hpp"

#include <nlohmann/json.hpp>

namespace lagroid::scene_tests {

inline std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The run in `parts`, whose last resumption printed `resumed`, left what the one in `whole` did, but for its seconds.
inline void expect_the_same_bits(const fs::path& whole, const fs::path& parts, const std::string& resumed) {
  for (const char* trajectory : {"trajectory.csv", "trajectory.h5"})
    EXPECT_TRUE(contents(whole / trajectory) == contents(parts / trajectory)) << trajectory;
  auto a = nlohmann::json::parse(contents(whole / "summary.json"));
  auto b = nlohmann::json::parse(resumed);
  a.erase("seconds");
  b.erase("seconds");
  EXPECT_EQ(a, b);
}

class Scenes : public CommandLine {};

}  // namespace lagroid::scene_tests
