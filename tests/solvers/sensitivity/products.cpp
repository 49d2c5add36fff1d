// Matrices of single steps, and their products over ten thousand: symplectic to round-off.

#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

namespace lagroid::sensitivity_products_tests {
namespace {

/// From a start where errors grow by less than 1e4.
template <class Sys> void expect_symplectic(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  constexpr long steps = 10'000;
  const Sensitivities end = sensitivities(system, start, SensitivityOptions<Sys>{.steps = steps});
  ASSERT_TRUE(end.converged()) << end.message;
  EXPECT_GT(end.by_start.norm(), 1);
  EXPECT_LT(end.by_start.norm(), 1e4);
  EXPECT_LE(laws::symplectic_defect(system, start, 1), 1e-13);
  EXPECT_LE(laws::symplectic_defect(system, start, steps), 1e-12);
}

TEST(SensitivityProducts, OfPendulumsAreSymplectic) {
  Pendulum pendulum;
  pendulum.h = 0.02;
  expect_symplectic(pendulum, {Vector<double, 1>(1.0), Vector<double, 1>(0.5)});
  SphericalPendulum spherical;
  spherical.h = 0.02;
  expect_symplectic(spherical, {{0.6, 0, -0.8}, {0.2, 0.5, 0.15}});
}
TEST(SensitivityProducts, OfKeplersProblemAreSymplectic) {
  Kepler kepler;
  kepler.h = 0.02;
  expect_symplectic(kepler, {{1, 0}, {0, 1.1}});
}
TEST(SensitivityProducts, OnGroupsAndActionsAreSymplectic) {
  RigidBody body;
  body.h = 0.02;
  expect_symplectic(body, {{}, {0.8, 0.6, 1.1}});
  HeavyTop top;
  top.h = 0.02;
  expect_symplectic(top, {{0, 0.6, 0.8}, {0.2, 0.1, 1.5}});
}

/// One entry that is off by a billionth.
TEST(SensitivityProducts, WithAWrongStepAreNot) {
  struct Wrong : laws::RunDerivatives {
    auto forward(const Pendulum& system, const State<Pair<1>>& start,
                 const SensitivityOptions<Pendulum>& options) const {
      Sensitivities found = sensitivities(system, start, options);
      found.by_start(0, 0) *= 1 + 1e-9;
      return found;
    }
  };
  Pendulum pendulum;
  pendulum.h = 0.02;
  EXPECT_GT(laws::symplectic_defect(pendulum, {Vector<double, 1>(1.0), Vector<double, 1>(0.5)}, 1, Wrong{}), 1e-13);
}

}  // namespace
}  // namespace lagroid::sensitivity_products_tests
