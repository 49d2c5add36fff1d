#pragma once
/// Defines the integrators by their options: what `make_integrator` and `step_for_accuracy` make. Include it for a
/// system of your own; those of systems/ are compiled in the library.

#include <lagroid/solvers/extrapolation/extrapolated_splitting.hpp>
#include <lagroid/solvers/integrators/adaptive.hpp>
#include <lagroid/solvers/integrators/composition.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/integrators/integrator_of.hpp>
#include <lagroid/solvers/integrators/runge_kutta.hpp>
#include <lagroid/solvers/integrators/splitting.hpp>
#include <lagroid/solvers/integrators/step_control.hpp>
#include <lagroid/solvers/integrators/times/prescribed.hpp>
#include <lagroid/solvers/integrators/transformed.hpp>
#include <lagroid/solvers/methods/methods.hpp>
#include <lagroid/solvers/step/step_methods.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace lagroid {

template <DiscreteSystem Sys> struct detail::Integrators {
  using Start = State<typename Sys::GroupoidType>;

  static std::unique_ptr<Integrator<Sys>> make(const Sys& system, const Start& initial,
                                               const ArrowOf<typename Sys::GroupoidType>& configuration,
                                               const IntegratorOptions& options) {
    if (const std::string why = why_not(options, capabilities_of(system)); !why.empty())
      throw std::invalid_argument(why);
    const auto solver = [&] { return make_step_solver(system, options.method, options.step); };
    if constexpr (Timed<Sys>) {
      if (options.mode == TimeMode::adaptive)
        return std::make_unique<IntegratorOf<Sys, AdaptiveIntegrator<Sys>>>(
            system, initial, configuration, solver(),
            make_step_solver(FreeTime<Sys>(system), options.method, options.step),
            AdaptiveOptions{.without_root = options.without_root});
      if constexpr (HasTimeScale<Sys>)
        if (options.mode == TimeMode::controlled)
          return std::make_unique<IntegratorOf<Sys, ControlledIntegrator<Sys>>>(system, initial, configuration,
                                                                                solver());
      if constexpr (HasTimeScaleOfArrows<Sys>)
        if (options.mode == TimeMode::prescribed)
          return std::make_unique<IntegratorOf<Sys, PrescribedIntegrator<Sys>>>(
              system, initial, configuration, solver(),
              make_step_solver(PrescribedStep<Sys, TimeScaleStep>(system, {}), options.method, options.step));
    }
    if constexpr (AttractiveSystem<Sys>)
      if (options.mode == TimeMode::transformed)
        return std::make_unique<IntegratorOf<Sys, TransformedIntegrator<Sys>>>(system, initial, configuration,
                                                                               options.composition);
    if constexpr (SplitSystem<Sys>)
      if (options.fixed == StepKind::splitting)
        return std::make_unique<IntegratorOf<Sys, SplittingIntegrator<Sys>>>(system, initial, configuration,
                                                                             options.composition);
    if constexpr (SplitSystem<Sys>)
      if (options.fixed == StepKind::extrapolation)
        return std::make_unique<IntegratorOf<Sys, ExtrapolatedSplitting<Sys>>>(system, initial, configuration,
                                                                               options.tolerance);
    if constexpr (HasRates<Sys>)
      if (options.fixed == StepKind::runge_kutta)
        return std::make_unique<IntegratorOf<Sys, RungeKuttaIntegrator<Sys>>>(system, initial, configuration);
    if constexpr (HasTimeStep<Sys> && Variational<Sys>)
      if (options.composition.stages() > 1)
        return std::make_unique<IntegratorOf<Sys, CompositionIntegrator<Sys>>>(system, initial, configuration,
                                                                               options.composition, solver);
    return std::make_unique<IntegratorOf<Sys, FixedStepIntegrator<Sys>>>(system, initial, configuration, solver());
  }

  static double step_for_accuracy(const Sys& system, const Start& initial, double accuracy,
                                  const IntegratorOptions& options) {
    using G = typename Sys::GroupoidType;
    const G& groupoid = system.groupoid;
    const auto error = [&](double h) {
      const auto unit = groupoid.unit(initial.object);
      Sys whole = system;
      whole.h = h;
      Sys half = system;
      half.h = 0.5 * h;
      FixedStepIntegrator<Sys> once(whole, initial, unit, make_step_solver(whole, options.method, options.step));
      FixedStepIntegrator<Sys> twice(half, initial, unit, make_step_solver(half, options.method, options.step));
      if (!once.advance().converged() || !twice.advance().converged() || !twice.advance().converged())
        return std::numeric_limits<double>::infinity();
      const auto& a = once.point();
      const auto& b = twice.point();
      const AlgebroidVector<G> momentum = tangent_momentum(whole, b.state);
      const AlgebroidVector<G> between =
          groupoid.tau_inverse(groupoid.multiply(groupoid.inverse(a.configuration), b.configuration));
      const AlgebroidVector<G> moved = groupoid.tau_inverse(b.configuration);
      return std::max(between.norm() / moved.norm(),
                      (tangent_momentum(whole, a.state) - momentum).norm() / momentum.norm());
    };
    constexpr int order = 2;  // of the error O(h^3) over the motion O(h)
    constexpr double close = 1.1;
    const double largest = 1e3 * system.h;  // where a step is exact whatever its size
    double h = system.h;
    for (int trial = 0; trial < 40; ++trial) {
      const double at = error(h);
      if (h >= largest && at <= accuracy) return h;
      const double factor = std::isfinite(at) ? std::clamp(std::pow(accuracy / at, 1.0 / order), 0.1, 4.0) : 0.25;
      if (factor < close && factor > 1 / close) return h * factor;
      h *= factor;
    }
    return 0;
  }
};

}  // namespace lagroid
