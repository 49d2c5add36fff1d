#include <lagroid/core/version.hpp>
#include <lagroid/run/machine.hpp>

#include <ceres/version.h>
#include <fmt/format.h>
#include <Eigen/Core>

#include <fstream>

#ifdef __GLIBC__
#include <gnu/libc-version.h>
#endif

namespace lagroid {

namespace {

/// The C library, and the instructions of this processor by which it chooses among its sines and exponentials.
std::string mathematical_library() {
  std::string out;
#ifdef __GLIBC__
  out += fmt::format(", glibc {}", gnu_get_libc_version());
#endif
#ifdef __x86_64__
  __builtin_cpu_init();
  if (__builtin_cpu_supports("fma")) out += " with fma";
  if (__builtin_cpu_supports("avx2")) out += " with avx2";
#endif
  return out;
}

}  // namespace

std::string program() {
  const std::string arch = LAGROID_ARCH;
  static const std::string library = mathematical_library();
  return fmt::format("{}{}, lagroid {}, Eigen {}.{}.{}, Ceres {}{}, build {}", LAGROID_COMPILER,
                     arch.empty() ? "" : " -march=" + arch, LAGROID_VERSION, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                     EIGEN_MINOR_VERSION, CERES_VERSION_STRING, library, build_hash());
}

std::string machine() {
  std::ifstream cpu("/proc/cpuinfo");
  std::string line;
  while (std::getline(cpu, line))
    if (line.starts_with("model name")) break;
  const auto colon = line.find(": ");
  return fmt::format("{}, {}", colon == std::string::npos ? "unknown processor" : line.substr(colon + 2), program());
}

}  // namespace lagroid
