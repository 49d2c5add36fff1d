#pragma once
/// The full motion of a reduced one.
///
///     q_k = beta(lift(q, c_k)),   c_k = h_1 h_2 ... h_k the configuration of the reduced run,   mu_k = A*Phi(q_k)
///     mu'_k
///
/// Corollary 4.6 of [G]: a trajectory of the reduced system lifts to one of the full system from any object over its
/// start. A reduced run keeps the product c_k anyway, so that each node lifts by itself and nothing adds up.
///
///     const auto reduced = ReducedSystem(RigidBodyOnPairs{}, LeftQuotient<SO3>{});
///     TrajectoryPoint<RigidBodyOnPairs> p = full_point(reduced, integrator.point(), q);
///     for (const auto& quantity : full_quantities(reduced, q)) ledger.watch(quantity);      // both momenta
///
/// Required: q over the source of the run's initial configuration, so that the lift of that arrow from q ends at the
/// initial object of the full motion; the object that stands for the source, where none is given. The multipliers are
/// those at the arrows that stand for the images: a constraint of which the zeros alone are invariant has others.

#include <lagroid/core/noether.hpp>
#include <lagroid/core/reduction/reduced_system.hpp>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lagroid {

/// The point of the full trajectory over a point of the reduced one; its configuration starts at `start`.
template <class Phi, class Sys>
TrajectoryPoint<Sys> full_point(const ReducedSystem<Phi, Sys>& reduced,
                                const TrajectoryPoint<ReducedSystem<Phi, Sys>>& p,
                                const ObjectOf<typename Phi::Domain>& start) {
  const auto& phi = reduced.morphism;
  TrajectoryPoint<Sys> out;
  out.index = p.index;
  out.time = p.time;
  out.step_size = p.step_size;
  out.configuration = phi.lift(start, p.configuration);
  const auto q = phi.from.target(out.configuration);
  out.state = phi.related(q, p.state.momentum);
  // The step that led here, found from its end.
  out.step = {phi.from.inverse(phi.lift(q, phi.to.inverse(p.index > 0 ? p.step.arrow : phi.to.unit(p.state.object)))),
              p.step.multipliers};
  return out;
}

template <class Phi, class Sys>
TrajectoryPoint<Sys> full_point(const ReducedSystem<Phi, Sys>& reduced,
                                const TrajectoryPoint<ReducedSystem<Phi, Sys>>& p) {
  return full_point(reduced, p, object_over(reduced.morphism, reduced.groupoid.source(p.configuration)));
}

/// What the full system watches, evaluated along a reduced run: its ledger, the momenta of its symmetries included.
template <class Phi, class Sys>
std::vector<Quantity<ReducedSystem<Phi, Sys>>> full_quantities(
    const ReducedSystem<Phi, Sys>& reduced, const std::optional<ObjectOf<typename Phi::Domain>>& start = {}) {
  using Below = ReducedSystem<Phi, Sys>;
  const auto lifted = [reduced, start](const TrajectoryPoint<Below>& p) {
    return start ? full_point(reduced, p, *start) : full_point(reduced, p);
  };
  std::vector<Quantity<Below>> out;
  for (auto& quantity : quantities_of(reduced.full)) {
    auto above = std::make_shared<Quantity<Sys>>(std::move(quantity));
    Quantity<Below> below{
        above->name, above->components, above->promise, above->needs_step,
        [above, lifted](const TrajectoryPoint<Below>& p, double* values) { above->evaluate(lifted(p), values); }};
    if (above->size) below.size = [above, lifted](const TrajectoryPoint<Below>& p) { return above->size(lifted(p)); };
    if (above->serialize) below.serialize = [above](NumberArchive& archive) { above->serialize(archive); };
    out.push_back(std::move(below));
  }
  return out;
}

}  // namespace lagroid
