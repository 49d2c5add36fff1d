#include "machine.hpp"

#include <lagroid/core/version.hpp>

#include <fmt/format.h>
#include <Eigen/Core>

#include <fstream>

namespace lagroid::app {

std::string program() {
  const std::string arch = LAGROID_ARCH;
  return fmt::format("{}{}, lagroid {}, Eigen {}.{}.{}", LAGROID_COMPILER, arch.empty() ? "" : " -march=" + arch,
                     LAGROID_VERSION, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
}

std::string machine() {
  std::ifstream cpu("/proc/cpuinfo");
  std::string line;
  while (std::getline(cpu, line))
    if (line.starts_with("model name")) break;
  const auto colon = line.find(": ");
  return fmt::format("{}, {}", colon == std::string::npos ? "unknown processor" : line.substr(colon + 2), program());
}

}  // namespace lagroid::app
