// The laws of exact derivatives with object constraints.

#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>

#include <gtest/gtest.h>

namespace lagroid::sensitivity_constrained_tests {
namespace {

using laws::draw_uniform;

TEST(SensitivityLaws, HoldWithObjectConstraints) {
  SphericalPendulum pendulum;
  pendulum.h = 0.05;
  const auto report = laws::sensitivity_laws(pendulum, [&] {
    const Vector<double, 3> q = Vector<double, 3>(draw_uniform(), draw_uniform(), -1).normalized();
    const Vector<double, 3> p(draw_uniform(), draw_uniform(), draw_uniform());
    return State<Pair<3>>{q, p - q.dot(p) * q};
  });
  EXPECT_TRUE(report.holds()) << report;
}

}  // namespace
}  // namespace lagroid::sensitivity_constrained_tests
