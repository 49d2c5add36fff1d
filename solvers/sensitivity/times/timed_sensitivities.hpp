#pragma once
/// Exact derivatives of runs whose steps vary, by their mode: as those of equal steps (sensitivities.hpp), and of the
/// time, which depends on the start and the parameters.
///
///     const Kepler kepler;
///     const Sensitivities end = sensitivities<TimeMode::adaptive>(kepler, {{1, 0}, {0, 1.2}}, {.steps = 200});
///     const RunGradient time = gradient<TimeMode::prescribed>(
///         kepler, {{1, 0}, {0, 1.2}}, [](const auto& node) { return node.time; }, {.steps = 200});
///
/// Rows of the end are (v, mu, t, p_t), after them epsilon where steps are prescribed; (v, mu, t, rho), rho the density
/// of steps, where they are controlled; (v, mu, t, E, s) in transformed time; columns of the start (v, mu). With the
/// momentum of time p_t the matrix pulls the form of the extended phase space back to that of the start, for adaptive
/// steps; prescribed ones add what epsilon depends on the start (linearised_timed_motion.hpp).
///
/// Requirements and errors are those of LinearisedTimedMotion, LinearisedControlledMotion and
/// LinearisedTransformedMotion, here by steps of order two; an integral over the run,
/// whose nodes' weights vary, is refused (std::invalid_argument). Nothing is taken past a step without root: its status
/// is `no_step`.

#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/solvers/sensitivity/times/linearised_controlled_motion.hpp>
#include <lagroid/solvers/sensitivity/times/linearised_timed_motion.hpp>
#include <lagroid/solvers/sensitivity/times/linearised_transformed_motion.hpp>

#include <utility>

namespace lagroid {

/// Whether runs whose steps vary in this way have derivatives.
template <class Sys, TimeMode mode>
concept TimedDerivatives = VaryingSteps<Sys, mode> ||(mode == TimeMode::controlled && VariedTimeScale<Sys>) ||
                           (mode == TimeMode::transformed && VariedAttraction<Sys>);

namespace detail {

template <class Sys, TimeMode mode> struct TimedMotion { using Type = LinearisedTimedMotion<Sys, mode>; };
template <class Sys> struct TimedMotion<Sys, TimeMode::controlled> { using Type = LinearisedControlledMotion<Sys>; };
template <class Sys> struct TimedMotion<Sys, TimeMode::transformed> { using Type = LinearisedTransformedMotion<Sys>; };

}  // namespace detail

/// A motion by such steps, linearised.
template <class Sys, TimeMode mode>
requires TimedDerivatives<Sys, mode>
using TimedMotion = typename detail::TimedMotion<Sys, mode>::Type;

template <TimeMode mode, class Sys>
requires TimedDerivatives<Sys, mode> Sensitivities sensitivities(const Sys& system,
                                                                 const State<typename Sys::GroupoidType>& start,
                                                                 const SensitivityOptions<Sys>& options = {}) {
  constexpr int n = Sys::dimension;
  TimedMotion<Sys, mode> motion(system, start, options.configuration.value_or(system.groupoid.unit(start.object)),
                                options.parameters, [](const auto& node) { return VariedVector(node.momentum); });
  const int count = motion.states() + motion.parameters();
  Propagated end = propagate_forward(motion, options.steps, Eigen::MatrixXd::Identity(count, count));
  // The momentum that is reported.
  if (end.converged()) end.end.middleRows(n, n) = end.derivatives;
  Sensitivities out = sensitivities_of(end, motion.states(), motion.parameter_names());
  if (out.converged()) out.by_start.conservativeResize(Eigen::NoChange, 2 * n);
  return out;
}

/// The derivatives of `f`, a function of an ObservedTimedNode, at a node or the end, taken backwards.
template <TimeMode mode, class Sys, class F>
requires TimedDerivatives<Sys, mode> RunGradient gradient(const Sys& system,
                                                          const State<typename Sys::GroupoidType>& start, F f,
                                                          const SensitivityOptions<Sys>& options = {}) {
  TimedMotion<Sys, mode> motion(system, start, options.configuration.value_or(system.groupoid.unit(start.object)),
                                options.parameters, detail::observer_of<ObservedTimedNode<Sys>>(std::move(f)));
  const Propagated back = propagate_backward(motion, options.steps, options.observed, options.budget);
  RunGradient out = gradient_of_run(back, motion.states(), motion.parameter_names());
  if (out.converged()) out.by_start.conservativeResize(Eigen::NoChange, 2 * Sys::dimension);
  return out;
}

}  // namespace lagroid
