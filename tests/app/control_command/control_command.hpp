// What tests of `lagroid control` share.
#pragma once

#include "../command_line.hpp"

#include <fstream>
#include <iterator>
#include <string>

namespace control_command_tests {

class ControlCommand : public CommandLine {
 protected:
  static std::string scene(const std::string& name) { return "control " + example("control/" + name); }
  static std::string text_of(const std::string& name) {
    std::ifstream file(fs::path(LAGROID_EXAMPLES) / "control" / (name + ".toml"));
    return {std::istreambuf_iterator<char>(file), {}};
  }
};

}  // namespace control_command_tests
