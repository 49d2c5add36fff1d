#pragma once
/// The motion of a system by the classical Runge-Kutta method, linearised. Its steps are taken in coordinates and drift
/// off the groupoid, so that derivatives are by all of these: by displacements along the groupoid, momenta, and what
/// lies across, which is zero at the start.
///
///     LinearisedRungeKutta<HeavyTop> motion(top, start, configuration, {"inertia"}, end_state);
///     const Propagated end = propagate_forward(motion, 100, directions);
///
/// States are (v, mu, y), as many as coordinates of an arrow and momenta; directions of a start have y = 0. Its steps
/// can be cut (CuttableExplicit). Requires `rates` over any scalar (HasVariedRates). Errors: those of
/// LinearisedExplicit.

#include <lagroid/core/capabilities/rates_over.hpp>
#include <lagroid/solvers/integrators/runge_kutta.hpp>
#include <lagroid/solvers/sensitivity/explicit/cuttable_explicit.hpp>

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid {

namespace detail {

/// The system whose time passes at a rate.
template <HasVariedRates Sys> struct RatesAtRate : Sys {
  using G = typename Sys::GroupoidType;
  static constexpr bool has_rate = true;

  explicit RatesAtRate(const Sys& system) : Sys(system) {}
  template <class S = double> RatesOver<G, S> rates(const State<G, S>& z) const {
    const RatesOver<G, S> whole = Sys::rates(z);
    if constexpr (std::is_same_v<S, double>) {
      return whole;
    } else {
      const auto r = varied<S>(rate);
      return {whole.velocity * r, whole.momentum * r};
    }
  }

  double rate = 1;
};

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
class LinearisedRungeKutta final
    : public CuttableExplicit<Sys, detail::RatesAtRate<Sys>, detail::RungeKuttaSteps<detail::RatesAtRate<Sys>>> {
 public:
  using G = typename Sys::GroupoidType;
  using System = detail::RatesAtRate<Sys>;
  using Steps = detail::RungeKuttaSteps<System>;

  LinearisedRungeKutta(const Sys& system, const State<G>& start, const ArrowOf<G>& configuration,
                       const std::vector<std::string>& parameters, ObserveNode<Sys> observe)
      : CuttableExplicit<Sys, System, Steps>(System(system), {System(system), start, configuration}, parameters,
                                             std::move(observe)) {}
};

}  // namespace lagroid
