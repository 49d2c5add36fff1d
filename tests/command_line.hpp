#pragma once
/// The program as a user runs it.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

namespace fs = std::filesystem;

struct Outcome {
  int code = 0;
  std::string out;
  std::string err;
};

class CommandLine : public ::testing::Test {
 protected:
  fs::path folder_ = fs::temp_directory_path() / ("lagroid_cli_" + std::to_string(::getpid()));
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// `before` is what the shell does first.
  Outcome run(const std::string& arguments, const std::string& before = "") const {
    const fs::path errors = folder_ / "stderr";
    const std::string command = before + std::string(LAGROID_PROGRAM) + " " + arguments + " 2>" + errors.string();
    Outcome r;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 4096> buffer{};
    while (const auto n = std::fread(buffer.data(), 1, buffer.size(), pipe)) r.out.append(buffer.data(), n);
    const int status = pclose(pipe);
    r.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    std::ifstream file(errors);
    r.err.assign(std::istreambuf_iterator<char>(file), {});
    return r;
  }
  static std::string example(const std::string& name) { return std::string(LAGROID_EXAMPLES) + "/" + name + ".toml"; }
  std::size_t entries() const {
    return std::size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
};
