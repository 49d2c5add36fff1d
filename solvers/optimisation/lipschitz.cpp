#include <lagroid/solvers/optimisation/lipschitz.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid::optimisation {

double largest_curvature(Problem& problem, const EvaluatedPoint& state, int steps) {
  const Manifold& manifold = problem.manifold();
  Vector v = state.gradient;
  Vector h(v.size());
  double largest = 0;
  constexpr double settled = 1e-3;
  for (int k = 0; k < steps; ++k) {
    const double length = manifold.norm(state.x, v);
    if (!(length > 0) || !std::isfinite(length)) break;
    v /= length;
    problem.hessian(state, v, h);
    const double found = manifold.norm(state.x, h);
    if (found <= (1 + settled) * largest) break;
    largest = found;
    v = h;
  }
  // A function without curvature along its gradient: its size is the only scale there is.
  return largest > 0 && std::isfinite(largest) ? largest : std::max(1e-300, manifold.norm(state.x, state.gradient));
}

double lipschitz_bound(Problem& problem, const EvaluatedPoint& state) {
  constexpr int power_steps = 50;
  constexpr double safety = 1.1;  // power steps come from below
  if (const auto declared = problem.objective().lipschitz()) return *declared;
  return safety * largest_curvature(problem, state, power_steps);
}

}  // namespace lagroid::optimisation
