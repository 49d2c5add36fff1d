// Built with LAGROID_REGISTER_BYTES=16 for this machine, as programs are that use a portable installation: layouts are
// the library's, whatever the caller's registers.
#include <lagroid/core/scalars/hyper_dual.hpp>
#include <lagroid/core/scalars/pack.hpp>
#include <lagroid/core/version.hpp>

#include <gtest/gtest.h>

#include <string>

using namespace lagroid;

namespace core_registers_tests {
namespace {

TEST(Registers, OfAnInstallationDecideTheLayout) {
  static_assert(detail::register_lanes<double>() == 2 && detail::register_lanes<float>() == 4);
  static_assert(sizeof(Pack<double, 3>) == 4 * sizeof(double) && alignof(Pack<double, 3>) == 16);
  static_assert(sizeof(Pack<double, 8>) == 8 * sizeof(double) && alignof(Pack<double, 8>) == 16);
  static_assert(alignof(Pack<double, 1>) == sizeof(double));
}

TEST(Registers, HoldAllNumbers) {
  const double x[] = {1, -2, 3, -4, 5};
  const double y[] = {10, 20, 30, 40, 50};
  const auto a = Pack<double, 5>::load(x);
  const auto b = Pack<double, 5>::load(y);
  const auto c = a + 2.0 * b - Pack<double, 5>::unit(4);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(c[i], x[i] + 2 * y[i] - (i == 4 ? 1 : 0));
}

TEST(Version, IsOne) {
  EXPECT_EQ(std::string(LAGROID_VERSION), std::to_string(LAGROID_VERSION_MAJOR) + "." +
                                              std::to_string(LAGROID_VERSION_MINOR) + "." +
                                              std::to_string(LAGROID_VERSION_PATCH));
  EXPECT_EQ(LAGROID_VERSION_NUMBER / 10000, LAGROID_VERSION_MAJOR);
  EXPECT_EQ(LAGROID_VERSION_NUMBER % 100, LAGROID_VERSION_PATCH);
}

}  // namespace
}  // namespace core_registers_tests
