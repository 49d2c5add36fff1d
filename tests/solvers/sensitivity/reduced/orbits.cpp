// Derivatives of reduced runs of an orbit: by a morphism and on a level of the momentum.

#include "reduced_runs.hpp"

#include <lagroid/systems/kepler.hpp>

#include <gtest/gtest.h>

namespace lagroid::sensitivity_reduced_orbits_tests {
namespace {

constexpr long steps = steps_of_reduced;

RunFrom<Kepler> orbit() {
  Kepler system;
  system.h = 0.05;
  const State<Pair<2>> start{{0.8, 0.1}, {0.2, 1.2}};
  return {system, start, Pair<2>::unit(start.object), {"strength"}};
}

TEST(ReducedOrbits, HaveTheDerivativesThatDifferencesTendTo) {
  expect_exact_derivatives(orbit(), reduced_by<0>(), steps);
  expect_exact_derivatives(orbit(), reduced_by<1>(), steps);
}

TEST(ReducedOrbits, HaveThemByComposedSteps) {
  expect_exact_derivatives(orbit(), reduced_by<0>(compositions::suzuki), steps);
  expect_exact_derivatives(orbit(), reduced_by<1>(compositions::suzuki), steps);
}

/// An attraction in a plane that may be tilted: what is no symmetry then has no derivatives of reduced runs.
struct Tilted : Kepler {
  double tilt = 0;
  template <class S, class T> S lagrangian(const PairArrow<S, 2>& g, const T& step) const {
    return Kepler::lagrangian(g, step) - (g.source(1) + g.target(1)) * (varied<S>(tilt) * 0.5) * step;
  }
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const { return lagrangian(g, h); }
  static auto parameters() { return std::tuple(parameter("tilt", &Tilted::tilt, "m/s^2", "of the plane")); }
};
TEST(ReducedOrbits, MissTheDifferencesByWhatBreaksTheSymmetry) {
  RunFrom<Tilted> from{{}, orbit().start, orbit().configuration, {}};
  from.system.h = 0.05;
  EXPECT_LT(missed_differences(from, reduced_by<0>(), reduced_by<0>(), steps), 1e-8);
  from.names = {"tilt"};
  EXPECT_GT(missed_differences(from, reduced_by<0>(), reduced_by<0>(), steps), 1e-2);
}

}  // namespace
}  // namespace lagroid::sensitivity_reduced_orbits_tests
