#pragma once
/// Energies along motions that keep a primary constraint.

#include <lagroid/solvers/galerkin/primary_constraint.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lagroid::subjects {

/// The largest change of energy in the first tenth of a run, and in the last; p = theta(q) at every node.
template <class Rule>
std::pair<double, double> energy_errors(const PrimaryConstraintStep<Rule>& by,
                                        const Vector<double, Rule::dimension>& start, double h, int steps) {
  auto z = by.on(start);
  const double energy = by.energy(start);
  double first = 0, last = 0;
  for (int k = 0; k < steps; ++k) {
    EXPECT_EQ(by.step(z, h), SolveStatus::converged) << k;
    if (::testing::Test::HasFailure()) break;
    const double change = std::abs(by.energy(z.object) - energy);
    if (k < steps / 10) first = std::max(first, change);
    if (k >= steps - steps / 10) last = std::max(last, change);
    EXPECT_LE((z.momentum - by.momentum(z.object)).norm(), 0) << k;
  }
  return {first, last};
}

}  // namespace lagroid::subjects
