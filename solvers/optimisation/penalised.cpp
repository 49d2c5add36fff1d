#include <lagroid/solvers/optimisation/manifolds/flat.hpp>
#include <lagroid/solvers/optimisation/penalised.hpp>

#include <fmt/format.h>

namespace lagroid::optimisation {

Result minimise_penalised(const Manifold& manifold, const Objective& objective, double weight, const Point& start,
                          DescentMethod& method, const Stopping& stopping, const Recording& recording) {
  constexpr double too_far = 0.1;
  const FlatSpace flat(manifold.size());
  const Penalised penalised(manifold, objective, weight);
  Result out = minimise(flat, penalised, start, method, stopping, recording);
  if (!out.x.allFinite() || out.x.size() != manifold.size()) return out;
  out.off_manifold = manifold.residual(out.x);
  EvaluatedPoint state;
  state.x = out.x;
  if (!(out.off_manifold <= too_far) || !manifold.nearest(state.x)) {
    out.outcome = MinimisationStatus::off_manifold;
    out.message =
        fmt::format("the penalty leaves the {} by {:.1e}; raise its weight", manifold.name(), out.off_manifold);
    return out;
  }
  Problem problem(manifold, objective);
  problem.evaluate(state);
  out.x = state.x;
  out.value = state.value;
  out.gradient = manifold.norm(state.x, state.gradient);
  out.residual = manifold.residual(out.x);
  return out;
}

}  // namespace lagroid::optimisation
