#pragma once
/// The program as a user runs it.

#include <gtest/gtest.h>

#include <algorithm>
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
#ifdef LAGROID_HAS_CHECK
  bool has_check_ = true;
#else
  bool has_check_ = false;  ///< a test that looks whether there is one says so
#endif
  fs::path folder_ = fs::temp_directory_path() / ("lagroid_cli_" + std::to_string(::getpid()));
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// `before` is what the shell does first.
  Outcome run(const std::string& arguments, const std::string& before = "") const {
    if (arguments.starts_with("check ") && !has_check_)
      ADD_FAILURE() << "`lagroid check` is a program of its own, which everyday builds do not have: "
                       "such tests are in check_command.cpp";
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
  /// Refused as bad input is: exit 2, and one line with these words.
  Outcome expect_refused(const std::string& arguments, const std::string& words = "") const {
    const Outcome r = run(arguments);
    EXPECT_EQ(r.code, 2) << arguments << "\n" << r.out << r.err;
    EXPECT_NE(r.err.find(words), std::string::npos) << arguments << "\n" << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << arguments << "\n" << r.err;
    return r;
  }

  fs::path write(const std::string& scene) const {
    const fs::path file = folder_ / "scene.toml";
    std::ofstream(file) << scene;
    return file;
  }
  /// A scene is refused by name, and leaves no folder.
  void expect_scene_refused(const std::string& scene, const std::string& words) const {
    SCOPED_TRACE(scene);
    const fs::path out = folder_ / "out";
    const Outcome r = expect_refused("run " + write(scene).string() + " --out " + out.string(), words);
    EXPECT_NE(r.err.find("scene.toml"), std::string::npos) << r.err;
    EXPECT_FALSE(fs::exists(out));
  }
  static std::string example(const std::string& name) { return std::string(LAGROID_EXAMPLES) + "/" + name + ".toml"; }
  std::size_t entries() const {
    return std::size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
};
