#pragma once
/// The principle of Hamilton and Pontryagin beside the rule that it is made of.

#include <lagroid/solvers/galerkin/hamilton_pontryagin.hpp>

#include "../subjects.hpp"

namespace lagroid::subjects {

/// They give the same steps.
template <class Rule> void expect_step_of(const State<typename Rule::GroupoidType>& start, double h, int steps) {
  auto plain = make(Rule{{}, h}, start);
  using Sys = HamiltonPontryagin<Rule>;
  const Sys system{{}, h};
  auto independent = make(system, Sys::extended(start));
  for (int k = 0; k < steps; ++k) {
    ASSERT_TRUE(plain.advance().converged()) << k;
    ASSERT_TRUE(independent.advance().converged()) << k;
  }
  const State<typename Rule::GroupoidType> s = Sys::reduced(independent.point().state);
  const auto& g = plain.system().groupoid;
  EXPECT_LT((plain.point().state.momentum - s.momentum).norm(), 1e-12);
  EXPECT_LT((g.coordinates_of_object(plain.point().state.object) - g.coordinates_of_object(s.object)).norm(), 1e-12);
  EXPECT_NEAR(system.energy(independent.point().state), plain.system().energy(plain.point().state), 1e-12);
}

}  // namespace lagroid::subjects
