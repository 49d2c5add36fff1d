#pragma once
/// Inner nodes eliminated inside an arrow or kept beside it.

#include <lagroid/solvers/galerkin/galerkin.hpp>
#include <lagroid/solvers/galerkin/galerkin_on_nodes.hpp>

#include "subjects.hpp"

namespace lagroid::subjects {

/// They give the same step. The points are those of Gauss in both.
template <class L, int Degree>
void expect_same_step(const State<typename L::GroupoidType>& start, double h, int steps) {
  auto inside = make(Galerkin<L, Degree>{L{}, h}, start);
  using Beside = GalerkinOnNodes<L, Degree>;
  auto beside = make(Beside{L{}, h}, Beside::extended(start));
  for (int k = 0; k < steps; ++k) {
    ASSERT_TRUE(inside.advance().converged()) << k;
    ASSERT_TRUE(beside.advance().converged()) << k;
  }
  const auto s = Beside::reduced(beside.point().state);
  EXPECT_LT((inside.point().state.momentum - s.momentum).norm(), 1e-12);
  const auto& g = inside.system().groupoid;
  EXPECT_LT((g.coordinates_of_object(inside.point().state.object) - g.coordinates_of_object(s.object)).norm(), 1e-12);
}

}  // namespace lagroid::subjects
