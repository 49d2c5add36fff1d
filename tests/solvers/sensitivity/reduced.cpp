// Derivatives of reduced runs: those of the full steps at the solutions that reduction finds.

#include "differences.hpp"

#include <lagroid/solvers/integrators/integrator_methods.hpp>
#include <lagroid/solvers/integrators/reduced_integrator.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <string>
#include <tuple>
#include <type_traits>

namespace lagroid::sensitivity_reduced_tests {
namespace {

constexpr long steps = 25;

RunFrom<Kepler> orbit() {
  Kepler system;
  system.h = 0.05;
  const State<Pair<2>> start{{0.8, 0.1}, {0.2, 1.2}};
  return {system, start, Pair<2>::unit(start.object), {"strength"}};
}
RunFrom<HeavyTop> top() {
  HeavyTop system;
  system.h = 0.05;
  RunFrom<HeavyTop> out{system, {{}, {0.3, 0.8, 0.4}}, {}, all_parameters(system).names};
  out.configuration = {SO3::exp(Vector<double, 3>(0.2, 0.3, 0.1)), Vector<double, 3>(0, 0, 1)};
  out.start.object = system.groupoid.target(out.configuration);
  return out;
}
RunFrom<RollingBall> ball() {
  RollingBall system;
  system.h = 0.05;
  const auto start = system.rolling({0.6, 0.1}, {0.2, -0.1}, 0.3);
  return {system, start, system.groupoid.unit(start.object), all_parameters(system).names};
}

template <std::size_t Place> auto reduced_by(const Composition& composition = compositions::single) {
  return [&composition]<class Sys>(const RunFrom<Sys>& from) {
    const auto declared = std::get<Place>(Sys::reductions());
    using Declared = std::remove_cvref_t<decltype(declared)>;
    const Reconstruction<Sys, Declared> down(declared, from.system, from.start, from.configuration);
    IntegratorOptions options;
    options.composition = composition;
    return std::make_unique<LinearisedMotionOf<Sys>>(
        from.system, std::make_unique<ReducedIntegrator<Sys, Declared>>(down, options), from.names, EndOfRun());
  };
}

TEST(ReducedSensitivities, OfMorphismsAreWhatDifferencesTendTo) {
  expect_exact_derivatives(orbit(), reduced_by<0>(), steps);
  expect_exact_derivatives(ball(), reduced_by<0>(), steps);
}

TEST(ReducedSensitivities, OfMomentumLevelsAreWhatDifferencesTendTo) {
  expect_exact_derivatives(orbit(), reduced_by<1>(), steps);
  expect_exact_derivatives(top(), reduced_by<0>(), steps);
}

TEST(ReducedSensitivities, OfComposedStepsAreWhatDifferencesTendTo) {
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
TEST(ReducedSensitivities, ByWhatBreaksTheSymmetryMissTheDifferences) {
  RunFrom<Tilted> from{{}, orbit().start, orbit().configuration, {}};
  from.system.h = 0.05;
  EXPECT_LT(missed_differences(from, reduced_by<0>(), reduced_by<0>(), steps), 1e-8);
  from.names = {"tilt"};
  EXPECT_GT(missed_differences(from, reduced_by<0>(), reduced_by<0>(), steps), 1e-2);
}

}  // namespace
}  // namespace lagroid::sensitivity_reduced_tests
