#pragma once
/// The motion of a scene's system by the scene's steps, linearised: which kinds of steps have derivatives, and by what.
///
///     require_derivatives_of_steps<Sys>(value, scene);
///     const auto motion = motion_of_steps(value, from, {"mass"}, observe);
///
/// Errors: SceneError for steps without derivatives. Of a motion WithoutDerivative, then or at its first linearised
/// step; std::invalid_argument for a reduction that another system does not have.

#include "../scenes/simulation.hpp"
#include "gradient_subject.hpp"

#include <lagroid/solvers/integrators/composition.hpp>
#include <lagroid/solvers/sensitivity/explicit/linearised_extrapolation.hpp>
#include <lagroid/solvers/sensitivity/explicit/linearised_runge_kutta.hpp>
#include <lagroid/solvers/sensitivity/explicit/linearised_splitting.hpp>
#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/solvers/sensitivity/times/timed_sensitivities.hpp>
#include <lagroid/systems/rotations/linearised_moser_veselov.hpp>

#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid::app {

/// Where a run begins.
template <DiscreteSystem Sys> struct Started {
  Sys system;
  State<typename Sys::GroupoidType> start;
  ArrowOf<typename Sys::GroupoidType> configuration;
};

namespace differentiating {

template <DiscreteSystem Sys>
std::unique_ptr<Integrator<Sys>> integrator_of(const Started<Sys>& from, const Composition& composition) {
  if constexpr (StepDependent<Sys>)
    if (composition.stages() > 1)
      return std::make_unique<lagroid::detail::IntegratorOf<Sys, CompositionIntegrator<Sys>>>(
          from.system, from.start, from.configuration, composition, [] { return std::make_unique<NewtonStep<Sys>>(); });
  SensitivityOptions<Sys> options;
  options.configuration = from.configuration;
  return lagroid::detail::newton_integrator(from.system, from.start, options);
}

/// By steps that vary, observed with the time after object and momentum.
template <TimeMode mode, DiscreteSystem Sys, class Observe, class... Option>
std::unique_ptr<LinearisedMotion> timed_motion(const Started<Sys>& from, const std::vector<std::string>& parameters,
                                               const Observe& observe, const Option&... option) {
  if constexpr (TimedDerivatives<Sys, mode>) {
    const auto with_time = [observe](const ObservedTimedNode<Sys>& node) {
      constexpr int first = Sys::GroupoidType::object_coordinate_count() + Sys::dimension;
      const VariedVector seen = observe(node);
      VariedVector all(seen.size() + 1);
      all << seen.head(first), node.time, seen.tail(seen.size() - first);
      return all;
    };
    return std::make_unique<TimedMotion<Sys, mode>>(from.system, from.start, from.configuration, parameters, with_time,
                                                    option...);
  } else {
    return nullptr;  // no scene of this system has such steps
  }
}

/// By explicit steps of equal size.
template <DiscreteSystem Sys, class Observe>
std::unique_ptr<LinearisedMotion> explicit_motion(const IntegratorOptions& options, const Started<Sys>& from,
                                                  const std::vector<std::string>& parameters, const Observe& observe) {
  if constexpr (HasVariedRates<Sys>)
    if (options.fixed == StepKind::runge_kutta)
      return std::make_unique<LinearisedRungeKutta<Sys>>(from.system, from.start, from.configuration, parameters,
                                                         observe);
  if constexpr (SplitSystem<Sys>)
    if (options.fixed == StepKind::splitting)
      return std::make_unique<LinearisedSplitting<Sys>>(from.system, from.start, from.configuration,
                                                        options.composition, parameters, observe);
  if constexpr (SplitSystem<Sys>)
    if (options.fixed == StepKind::extrapolation)
      return std::make_unique<LinearisedExtrapolation<Sys>>(from.system, from.start, from.configuration,
                                                            options.tolerance, parameters, observe);
  return nullptr;  // no scene of this system has such steps
}

/// By the method that a system alone has, to this order.
template <DiscreteSystem Sys, class Observe>
std::unique_ptr<LinearisedMotion> own_motion(int order, const Started<Sys>& from,
                                             const std::vector<std::string>& parameters, const Observe& observe) {
  if constexpr (std::is_same_v<Sys, RigidBody>)
    return std::make_unique<LinearisedMoserVeselov>(from.system, from.start, from.configuration, order, parameters,
                                                    observe);
  return nullptr;  // no scene of this system has such steps
}

}  // namespace differentiating

/// Whether steps are those of the discrete Lagrangian, of equal size, perhaps composed; reduced ones are, too.
template <DiscreteSystem Sys> bool by_variational_steps(const StatedInitialValue<Sys>& value) {
  const IntegratorOptions& options = value.choice.options;
  return options.mode == TimeMode::fixed && options.fixed == StepKind::variational && value.own_order == 0;
}
/// The integrator of variational steps. Those of a reduced run are those of the full one, found on a smaller groupoid:
/// at their solutions the equations of the full system hold, and its derivatives are theirs.
template <DiscreteSystem Sys>
std::unique_ptr<Integrator<Sys>> variational_integrator(const StatedInitialValue<Sys>& value,
                                                        const Started<Sys>& from) {
  if (value.reduced) return value.reduced(from.system, from.start, from.configuration);
  return differentiating::integrator_of(from, value.choice.options.composition);
}

/// Whether they are explicit ones that can be made in part: compositions of flows, or Runge-Kutta steps.
template <DiscreteSystem Sys> bool by_explicit_steps_in_parts(const StatedInitialValue<Sys>& value) {
  const IntegratorOptions& options = value.choice.options;
  return options.mode == TimeMode::fixed && !value.reduced &&
         (options.fixed == StepKind::splitting || options.fixed == StepKind::runge_kutta);
}

template <DiscreteSystem Sys>
void require_derivatives_of_steps(const StatedInitialValue<Sys>& value, const Section& scene) {
  IntegratorChoice choice = value.choice;
  IntegratorOptions& options = choice.options;
  // Steps of the first one's size where others have no root are solved by Newton, too.
  if (options.without_root == WithoutRoot::constant) options.without_root = WithoutRoot::stop;
  if (value.reduced) {
    if (!by_newton_steps(choice))
      scene.fail("time",
                 "gradient takes reduced runs by equal steps of a given size, perhaps composed, solved by Newton to "
                 "round-off; leave out other modes and methods, accuracy and [solver], or reduce");
    return;
  }
  const bool is_explicit = options.mode == TimeMode::transformed ||
                           (options.mode == TimeMode::fixed && options.fixed != StepKind::variational);
  if (!solved_by_newton(choice) && !is_explicit) {
    if (options.without_root == WithoutRoot::controlled)
      scene.section("time", "")
          .fail("without_root",
                "steps that a control gives where there is no root have no derivatives; leave it "
                "out, or take \"constant\" or mode = \"controlled\"");
    scene.fail("solver", "derivatives are of steps that Newton's iteration solves to round-off; leave it out");
  }
  if (options.fixed == StepKind::runge_kutta && !HasVariedRates<Sys>)
    scene.fail("time", "the rates of this system have no derivatives; leave out method = \"runge-kutta\"");
  if (options.fixed == StepKind::extrapolation && Sys::object_constraints > 0)
    scene.fail(
        "time",
        "extrapolated steps have derivatives along constraints of places alone, off which inner steps are others; "
        "take method = \"splitting\"");
  if (options.mode == TimeMode::transformed && !TimedDerivatives<Sys, TimeMode::transformed>)
    scene.fail("time", "the energies of this system have no derivatives; take another mode");
  if (options.mode == TimeMode::controlled && !TimedDerivatives<Sys, TimeMode::controlled>)
    scene.fail("time",
               "the time scale by which steps of this system are controlled has no derivatives; take "
               "mode = \"adaptive\" or equal steps");
}

/// Why no scene has its steps from there; empty where one has.
template <DiscreteSystem Sys>
std::string refusal_of_steps(const StatedInitialValue<Sys>& value, const Started<Sys>& from) {
  if constexpr (std::is_same_v<Sys, RigidBody>) try {
      if (value.own_order > 0)
        MoserVeselov::preprocessed(from.system.inertia, from.start.momentum, from.system.h, value.own_order);
    } catch (const std::domain_error& error) {
      return error.what();
    }
  return "";
}

template <DiscreteSystem Sys, class Observe>
std::unique_ptr<LinearisedMotion> motion_of_steps(const StatedInitialValue<Sys>& value, const Started<Sys>& from,
                                                  const std::vector<std::string>& parameters, const Observe& observe) {
  const IntegratorOptions& options = value.choice.options;
  if (value.own_order > 0) return differentiating::own_motion(value.own_order, from, parameters, observe);
  if (options.mode == TimeMode::adaptive)
    return differentiating::timed_motion<TimeMode::adaptive>(from, parameters, observe, options.without_root);
  if (options.mode == TimeMode::prescribed)
    return differentiating::timed_motion<TimeMode::prescribed>(from, parameters, observe);
  if (options.mode == TimeMode::controlled)
    return differentiating::timed_motion<TimeMode::controlled>(from, parameters, observe);
  if (options.mode == TimeMode::transformed)
    return differentiating::timed_motion<TimeMode::transformed>(from, parameters, observe, options.composition);
  if (options.fixed != StepKind::variational)
    return differentiating::explicit_motion(options, from, parameters, observe);
  return std::make_unique<LinearisedMotionOf<Sys>>(from.system, variational_integrator(value, from), parameters,
                                                   observe);
}

}  // namespace lagroid::app
