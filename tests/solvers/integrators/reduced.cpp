// Reduced runs as integrators of the full system: they have its motion, and a step takes no memory.

#include <lagroid/solvers/integrators/reduced_integrator.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>
#include <lagroid/systems/rotations/gyrostat.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include "../../support/allocation_counter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

namespace lagroid {

// Compiled in the library.
using KeplerByRotations = ReducedBy<Kepler, 0>;
using KeplerAtItsMomentum = ReducedBy<Kepler, 1>;
using TopAtItsMomentum = ReducedBy<HeavyTop, 0>;
using GyrostatAtItsMomenta = ReducedBy<Gyrostat, 0>;
using RollingBallByRotations = ReducedBy<RollingBall, 0>;
using PlateBallByTranslations = ReducedBy<PlateBall, 0>;
LAGROID_STEP_SOLVERS(extern template, KeplerByRotations);
LAGROID_STEP_SOLVERS(extern template, KeplerAtItsMomentum);
LAGROID_STEP_SOLVERS(extern template, TopAtItsMomentum);
LAGROID_STEP_SOLVERS(extern template, GyrostatAtItsMomenta);
LAGROID_STEP_SOLVERS(extern template, RollingBallByRotations);
LAGROID_STEP_SOLVERS(extern template, PlateBallByTranslations);

namespace integrators_reduced_tests {
namespace {

template <std::size_t Place, class Sys>
ReducedIntegrator<Sys, ReductionAt<Sys, Place>> reduced_run(const Sys& system,
                                                            const State<typename Sys::GroupoidType>& start,
                                                            const Composition& composition = compositions::single) {
  const Reconstruction<Sys, ReductionAt<Sys, Place>> down(std::get<Place>(Sys::reductions()), system, start,
                                                          system.groupoid.unit(start.object));
  return {down, {.composition = composition}};
}

template <std::size_t Place, class Sys>
long allocations(const Sys& system, const State<typename Sys::GroupoidType>& start,
                 const Composition& composition = compositions::single) {
  auto run = reduced_run<Place>(system, start, composition);
  EXPECT_TRUE(run.advance().converged());
  const long before = allocation_count();
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(run.advance().converged());
  return allocation_count() - before;
}

RollingBall ball() {
  RollingBall out;
  out.plate_rate = 1;
  return out;
}
State<RollingBall::GroupoidType> rolling() { return ball().rolling({0.5, 0.1}, {0, 0.3}, 0.4); }
PlateBall plate_ball() {
  PlateBall out;
  out.rotation = RotationForm::exponential;
  out.spin = 0.5;
  return out;
}
State<PlateBall::GroupoidType> controlled() {
  State<PlateBall::GroupoidType> z{{Vector<double, 2>(0.2, -0.1), {}}, {}};
  z.momentum << 0.9, 0.2, 0.6, -0.4, 0.8;
  return z;
}

/// The largest difference from the full system's own run over a thousand steps, relative to one and the size there.
template <class Sys> double difference(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  const auto full = make_integrator(system, start, system.groupoid.unit(start.object), {});
  auto reduced = reduced_run<0>(system, start);
  double most = 0;
  for (int k = 0; k < 1000; ++k) {
    EXPECT_TRUE(full->advance().converged());
    EXPECT_TRUE(reduced.advance().converged());
    const auto compare = [&](const auto& there, const auto& here) {
      most = std::max(most, (there - here).norm() / (1 + here.norm()));
    };
    const auto& here = full->point();
    const auto& there = reduced.point();
    const auto& groupoid = system.groupoid;
    compare(there.state.momentum, here.state.momentum);
    compare(groupoid.coordinates_of_arrow(there.configuration), groupoid.coordinates_of_arrow(here.configuration));
    compare(there.step.multipliers, here.step.multipliers);
  }
  return most;
}

TEST(ReducedIntegrator, HasTheFullMotionOfBalls) {
  EXPECT_LT(difference(ball(), rolling()), 1e-10);
  EXPECT_LT(difference(plate_ball(), controlled()), 1e-10);
  PlateBall turning = plate_ball();
  turning.plate_rate = 1e-3;
  EXPECT_GT(difference(turning, controlled()), 1e-6) << "translations are no symmetry of it";
}

TEST(ReducedIntegrator, AllocatesNothing) {
  if (allocation_count() < 0) GTEST_SKIP() << "not counted under AddressSanitizer";
  Kepler kepler;
  kepler.h = 0.01;
  const State<Pair<2>> planet{Vector<double, 2>(1, 0), Vector<double, 2>(0, 1.1)};
  HeavyTop top;
  top.h = 0.01;
  const State<HeavyTop::GroupoidType> spinning{Vector<double, 3>(0.6, 0, 0.8), Vector<double, 3>(0.4, 0.3, 2)};
  Gyrostat gyrostat;
  gyrostat.h = 0.01;
  State<Gyrostat::GroupoidType> turning{{}, {}};
  turning.momentum << 1.2, 0.3, -0.5, 0.2, -0.1, 0.3;
  for (const auto& composition : {compositions::single, compositions::suzuki}) {
    EXPECT_EQ(allocations<0>(kepler, planet, composition), 0) << composition.name;
    EXPECT_EQ(allocations<1>(kepler, planet, composition), 0) << composition.name;
    EXPECT_EQ(allocations<0>(gyrostat, turning, composition), 0) << composition.name;
  }
  EXPECT_EQ(allocations<0>(top, spinning), 0);
  EXPECT_EQ(allocations<0>(ball(), rolling()), 0);
  EXPECT_EQ(allocations<0>(plate_ball(), controlled()), 0);
}

}  // namespace
}  // namespace integrators_reduced_tests

}  // namespace lagroid
