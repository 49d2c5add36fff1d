#pragma once
/// The integrators of point masses: of (q, p).

#include "ours.hpp"

#include <lagroid/groupoids/pair.hpp>

namespace peers {

template <class Sys, class P> std::vector<Method> mechanical_integrators(const P& problem, const Sys& system) {
  constexpr int n = Sys::dimension;
  const auto y = problem.start();
  lagroid::State<lagroid::Pair<n>> start;
  for (int i = 0; i < n; ++i) {
    start.object(i) = y[std::size_t(i)];
    start.momentum(i) = y[std::size_t(n + i)];
  }
  const auto coordinates = [system](const lagroid::TrajectoryPoint<Sys>& point) {
    std::array<double, 2 * std::size_t(n)> out;
    const lagroid::Vector<double, n> momentum = lagroid::tangent_momentum(system, point.state);
    for (int i = 0; i < n; ++i) {
      out[std::size_t(i)] = point.state.object(i);
      out[std::size_t(n + i)] = momentum(i);
    }
    return out;
  };
  return integrators(problem, system, start, system.groupoid.unit(start.object), coordinates);
}

}  // namespace peers
