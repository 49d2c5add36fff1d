#pragma once
/// What the laws of local symplectic groupoids are asked of: points away from the coordinate planes, arrows near units.

#include <lagroid/core/testing/symplectic_groupoid_laws.hpp>
#include <lagroid/groupoids/poisson/symplectic_groupoid.hpp>

#include <gtest/gtest.h>

namespace lagroid {

inline constexpr laws::GroupoidLawOptions near_units{
    .large = 0.4, .local = 0.4, .tolerance = 1e-12, .derivative = 1e-11};

/// Between 0.5 and 1.5.
template <int N> Vector<double, N> draw_point() {
  Vector<double, N> x;
  for (int i = 0; i < N; ++i) x(i) = 1 + 0.5 * laws::draw_uniform();
  return x;
}

template <class G> void expect_all_laws(const G& groupoid) {
  const auto axioms = laws::groupoid_laws(groupoid, draw_point<G::dimension>, near_units);
  EXPECT_TRUE(axioms.holds()) << axioms;
  const auto symplectic = laws::symplectic_groupoid_laws(groupoid, draw_point<G::dimension>, near_units);
  EXPECT_TRUE(symplectic.holds()) << symplectic;
}

}  // namespace lagroid
