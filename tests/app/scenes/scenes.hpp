#pragma once
/// Tests of scenes of bodies through the program.

#include "../command_line.hpp"

namespace lagroid::scene_tests {

inline std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Scenes : public CommandLine {};

}  // namespace lagroid::scene_tests
