// How long a user's file takes to compile, with the command the build itself uses.
#include "../report/comparison.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace bench {

namespace {

/// Seconds for one run of the command, without a compiler cache.
double seconds(const std::string& command, const std::string& directory) {
  const auto start = std::chrono::steady_clock::now();
  const int status = std::system(fmt::format("cd '{}' && CCACHE_DISABLE=1 {}", directory, command).c_str());
  if (status != 0) throw std::runtime_error("this did not compile: " + command);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::string compile_times() {
  std::ifstream file(LAGROID_BUILD "/compile_commands.json");
  if (!file) throw std::runtime_error("no " LAGROID_BUILD "/compile_commands.json: configure with CMake first");
  std::string out = "| file | seconds | wanted |\n|---|---|---|\n";
  for (const auto& entry : nlohmann::json::parse(file)) {
    const std::string path = entry.at("file");
    const auto at = path.find("bench/user/");
    if (at == std::string::npos) continue;
    out += fmt::format("| {} | {:.1f} | at most 8 |\n", path.substr(at),
                       seconds(entry.at("command"), entry.at("directory")));
  }
  return out;
}

}  // namespace bench
