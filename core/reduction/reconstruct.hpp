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
/// initial object of the full motion; the object that stands for the source, where none is given. Of a constraint of
/// which the zeros alone are invariant the multipliers are those that make the same reaction.

#include <lagroid/core/derivatives/annihilator.hpp>
#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/matrices/scaling.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/core/reduction/reduced_system.hpp>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lagroid {

namespace detail {

/// What the multipliers of arrow constraints multiply: covectors of the distribution at the source of g, or derivatives
/// of the constraints as its target moves.
template <DiscreteSystem Sys>
Matrix<double, Sys::dimension, Sys::arrow_constraints> reactions(const Sys& system,
                                                                 const ArrowOf<typename Sys::GroupoidType>& g) {
  constexpr int n = Sys::dimension;
  const auto& groupoid = system.groupoid;
  if constexpr (Nonholonomic<Sys>) {
    return annihilator(system, ObjectOf<typename Sys::GroupoidType>(groupoid.source(g)));
  } else {
    Matrix<double, n, Sys::arrow_constraints> out;
    for (int i = 0; i < n; ++i) {
      const auto w = infinitesimal(Vector<double, n>(Vector<double, n>::Unit(i)));
      out.row(i) =
          derivative_of(system.constraint(groupoid.extend(groupoid.template cast<Dual<double>>(g), w))).transpose();
    }
    return out;
  }
}

/// Those at the arrow g over the last one of p, for the same reaction.
template <class Phi, class Sys>
typename Sys::Multipliers full_multipliers(const ReducedSystem<Phi, Sys>& reduced,
                                           const TrajectoryPoint<ReducedSystem<Phi, Sys>>& p,
                                           const ArrowOf<typename Phi::Domain>& g) {
  constexpr int k = Sys::arrow_constraints;
  typename Sys::Multipliers lambda = p.step.multipliers;
  if constexpr (k > 0) {
    if (p.index == 0) return lambda;
    ReducedSystem<Phi, Sys> there = reduced;
    set_time_step(there, p.step_size);
    if constexpr (TimeDependent<Sys>) there.time = p.time - p.step_size;
    const auto& groupoid = there.full.groupoid;
    const ObjectOf<typename Phi::Domain> q = Nonholonomic<Sys> ? groupoid.source(g) : groupoid.target(g);
    const AlgebroidVector<typename Phi::Codomain> below = reactions(there, p.step.arrow) * lambda.template head<k>();
    const auto above = reactions(there.full, g);
    const Matrix<double, k, k> products = above.transpose() * above;
    lambda.template head<k>() = lagroid::solve_equilibrated(
        products, Vector<double, k>(above.transpose() * there.morphism.related(q, below).momentum));
  }
  return lambda;
}

}  // namespace detail

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
  out.step.arrow =
      phi.from.inverse(phi.lift(q, phi.to.inverse(p.index > 0 ? p.step.arrow : phi.to.unit(p.state.object))));
  out.step.multipliers = detail::full_multipliers(reduced, p, out.step.arrow);
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
