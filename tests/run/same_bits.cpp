// The same program, the same scene, the same bits: whatever the number of threads and processors.

#include "../app/command_line.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string>

namespace run_same_bits_tests {
namespace {

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class SameBits : public CommandLine {};

TEST_F(SameBits, WhateverTheThreadsAndProcessors) {
  struct Case {
    const char* scene;
    const char* settings;
  };
  const Case cases[] = {{"rigid_body", ""},
                        {"kepler", " --set time.steps=500 --set solver.method=ceres"},
                        {"kepler_adaptive", " --set time.steps=500"},
                        {"spherical_pendulum", " --set time.method=splitting --set time.composition=nystrom-6"},
                        {"plate_ball", ""},
                        {"kepler_boundary", " --set solver.method=ceres"},
                        {"chain_drop", " --set time.steps=200"},
                        {"figure_eight", " --set time.order=6 --set time.steps=500"}};
  for (const Case& each : cases) {
    std::string first;
    const char* surroundings[] = {"OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 taskset -c 0 ",
                                  "OMP_NUM_THREADS=4 OPENBLAS_NUM_THREADS=4 "};
    for (const char* around : surroundings) {
      const fs::path out = folder_ / "out";
      fs::remove_all(out);
      const Outcome r = run(fmt::format("run {}{} --out {}", example(each.scene), each.settings, out.string()), around);
      ASSERT_EQ(r.code, 0) << each.scene << ": " << r.err;
      const std::string rows = contents(out / "trajectory.csv");
      ASSERT_GT(rows.size(), 1000u) << each.scene;
      if (first.empty()) first = rows;
      EXPECT_TRUE(rows == first) << each.scene << each.settings;
    }
  }
}

}  // namespace
}  // namespace run_same_bits_tests
