#pragma once
/// What a typed refusal is.

#include <lagroid/core/quantity.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <cstring>

namespace lagroid::hard {

/// Equal to the bit, NaN or not.
template <class A> bool same_bits(const A& a, const A& b) {
  return a.size() == b.size() &&
         (a.size() == 0 || std::memcmp(a.data(), b.data(), std::size_t(a.size()) * sizeof(*a.data())) == 0);
}

/// Nothing of a trajectory's point has moved.
template <class Sys> bool unmoved(const TrajectoryPoint<Sys>& before, const TrajectoryPoint<Sys>& after) {
  const typename Sys::GroupoidType groupoid{};
  const auto same = [](const auto& a, const auto& b) { return same_bits(a.eval(), b.eval()); };
  return before.index == after.index && before.time == after.time &&
         same(before.state.momentum, after.state.momentum) &&
         same(groupoid.coordinates_of_object(before.state.object),
              groupoid.coordinates_of_object(after.state.object)) &&
         same(groupoid.coordinates_of_arrow(before.configuration), groupoid.coordinates_of_arrow(after.configuration));
}

/// 0 where the next step of an integrator is refused by a typed status and leaves its point to the bit,
/// else 1.
template <class Integrating> double refusal(Integrating& integrating) {
  const auto before = integrating.point();
  const SolveStatus status = integrating.advance().status;
  return status != SolveStatus::converged && unmoved(before, integrating.point()) ? 0 : 1;
}

}  // namespace lagroid::hard
