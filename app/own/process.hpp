#pragma once
/// Other programs, run to their ends.
///
///     const int code = run_process({"cmake", "--version"}, {.out = "version.txt"});
///
/// Errors: std::system_error where the program cannot be started.

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid::app {

/// Where what a program prints goes; empty: where ours does.
struct Streams {
  std::filesystem::path out{};
  std::filesystem::path error{};
};

/// Runs a program, found by PATH where its name has no slash, and waits for it. Returns its exit code, or 128 and the
/// number of the signal that ended it. Throws std::system_error where it cannot be started.
int run_process(const std::vector<std::string>& words, const Streams& streams = {});

}  // namespace lagroid::app
