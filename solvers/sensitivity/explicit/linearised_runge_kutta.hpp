#pragma once
/// The motion of a system by the classical Runge-Kutta method, linearised. Its steps are taken in coordinates and drift
/// off the groupoid, so that derivatives are by all of these: by displacements along the groupoid, momenta, and what
/// lies across, which is zero at the start.
///
///     LinearisedRungeKutta<HeavyTop> motion(top, start, configuration, {"inertia"}, end_state);
///     const Propagated end = propagate_forward(motion, 100, directions);
///
/// States are (v, mu, y), as many as coordinates of an arrow and momenta; directions of a start have y = 0. Requires
/// `rates` over any scalar (HasVariedRates). Errors: those of LinearisedExplicit.

#include <lagroid/core/capabilities/rates_over.hpp>
#include <lagroid/solvers/integrators/runge_kutta.hpp>
#include <lagroid/solvers/sensitivity/explicit/linearised_explicit.hpp>

#include <string>
#include <utility>
#include <vector>

namespace lagroid {

namespace detail {

template <HasVariedRates Sys> class RungeKuttaSteps : public RungeKuttaIntegrator<Sys> {
 public:
  using G = typename Sys::GroupoidType;
  using Chart = CoordinateChart<Sys>;
  using RungeKuttaIntegrator<Sys>::RungeKuttaIntegrator;

  template <class S> NodeOver<G, S> step(const Sys& system, const NodeOver<G, S>& from) const {
    const G& groupoid = system.groupoid;
    const auto reached = RungeKuttaStep<Sys, S>(system).from(
        {groupoid.coordinates_of_arrow(from.configuration), from.momentum}, system.h);
    const ArrowOf<G, S> configuration = groupoid.template arrow_at<S>(reached.arrow);
    return {groupoid.target(configuration), reached.momentum, configuration};
  }
};

}  // namespace detail

template <HasVariedRates Sys>
class LinearisedRungeKutta final : public LinearisedExplicit<Sys, detail::RungeKuttaSteps<Sys>> {
 public:
  using G = typename Sys::GroupoidType;

  LinearisedRungeKutta(const Sys& system, const State<G>& start, const ArrowOf<G>& configuration,
                       const std::vector<std::string>& parameters, ObserveNode<Sys> observe)
      : LinearisedExplicit<Sys, detail::RungeKuttaSteps<Sys>>(system, {system, start, configuration}, parameters,
                                                              std::move(observe)) {}
};

}  // namespace lagroid
