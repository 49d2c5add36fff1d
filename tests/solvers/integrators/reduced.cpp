// Reduced runs as integrators of the full system: a step takes no memory, that of the full motion included.

#include <lagroid/solvers/integrators/reduced_integrator.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/rotations/gyrostat.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include "../../support/allocation_counter.hpp"

#include <gtest/gtest.h>

#include <cstddef>

namespace lagroid {

// Compiled in the library.
using KeplerByRotations = ReducedBy<Kepler, 0>;
using KeplerAtItsMomentum = ReducedBy<Kepler, 1>;
using TopAtItsMomentum = ReducedBy<HeavyTop, 0>;
using GyrostatAtItsMomenta = ReducedBy<Gyrostat, 0>;
LAGROID_STEP_SOLVERS(extern template, KeplerByRotations);
LAGROID_STEP_SOLVERS(extern template, KeplerAtItsMomentum);
LAGROID_STEP_SOLVERS(extern template, TopAtItsMomentum);
LAGROID_STEP_SOLVERS(extern template, GyrostatAtItsMomenta);

namespace {

template <std::size_t Place, class Sys>
long allocations(const Sys& system, const State<typename Sys::GroupoidType>& start, const Composition& composition) {
  using Declared = ReductionAt<Sys, Place>;
  const Reconstruction<Sys, Declared> down(std::get<Place>(Sys::reductions()), system, start,
                                           system.groupoid.unit(start.object));
  ReducedIntegrator<Sys, Declared> run(down, {.composition = composition});
  EXPECT_TRUE(run.advance().converged());
  const long before = allocation_count();
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(run.advance().converged());
  return allocation_count() - before;
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
  EXPECT_EQ(allocations<0>(top, spinning, compositions::single), 0);
}

}  // namespace

}  // namespace lagroid
