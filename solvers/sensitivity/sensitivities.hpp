#pragma once
/// Exact derivatives of a run, of the discrete map itself: how its end depends on its start and on the parameters,
///
///     x_N = (q_N, mu_N),    d x_N / d x_0  and  d x_N / d theta,    or the gradient of any function of its nodes.
///
/// Nothing is differenced, and no iteration is differentiated: each step is linearised at its solution. The matrix is
/// symplectic as the step is, and gradients taken backwards are those taken forwards.
///
///     const Pendulum pendulum;
///     const Sensitivities end = sensitivities(pendulum, {Vector<double, 1>(1.0), Vector<double, 1>(0.5)},
///                                             {.steps = 100, .parameters = {"mass", "length"}});
///     const Eigen::MatrixXd transition = end.by_start;
///
/// Requires a system whose functions are templates on the scalar, and formulas that read the parameters in question by
/// `varied` (core/scalars/varied.hpp). By equal steps of the discrete Lagrangian, each solved by Newton's iteration;
/// another integrator is an argument. Columns of the start are the displacement v of the configuration, g_0 tau(v), and
/// the momentum, in the basis of the displaced object; rows of the end likewise. With object constraints displacements
/// are tangent, and the end's momentum is the one that is reported (tangent_momentum).
///
/// Errors: std::invalid_argument for a name that is no parameter; WithoutDerivative, naming it, for one that the system
/// reads as a plain number. A step that fails is a status and a message. Source: [G] Def. 3.3 and implicit function
/// theorem; docs/gradients.md.

#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/integrators/integrator_of.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion_of.hpp>
#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

template <DiscreteSystem Sys> struct SensitivityOptions {
  long steps = 1000;
  std::vector<std::string> parameters = {};  ///< by which derivatives are taken, beside the start
  std::optional<ArrowOf<typename Sys::GroupoidType>> configuration = {};  ///< an attitude; else the start's unit
  Observed observed = {};                                                 ///< of `gradient`: at which nodes
  StateBudget budget = {};                                                ///< of `gradient`
};

/// How the end of a run depends on its start and its parameters.
struct Sensitivities {
  SolveStatus status = SolveStatus::converged;
  std::string message;
  std::vector<std::string> parameters;  ///< mass, inertia.0, ...: the columns of by_parameters
  Eigen::MatrixXd by_start;             ///< 2 n x 2 n, of (displacement, momentum)
  Eigen::MatrixXd by_parameters;
  double growth = 1;       ///< the largest factor, on the way, by which errors of the start grew
  double digits_left = 0;  ///< of sixteen, by the growth

  bool converged() const { return status == SolveStatus::converged; }
};

/// How functions of a run depend on its start and its parameters: a row for each.
struct RunGradient {
  SolveStatus status = SolveStatus::converged;
  std::string message;
  std::vector<std::string> parameters;
  Eigen::VectorXd values;
  Eigen::MatrixXd by_start;
  Eigen::MatrixXd by_parameters;
  double growth = 1;
  double digits_left = 0;
  long steps_solved = 0;  ///< in all, those computed again too
  long states_kept = 0;   ///< at most, at a time

  bool converged() const { return status == SolveStatus::converged; }
};

/// The results, from what was propagated.
Sensitivities sensitivities_of(const Propagated& end, int states, std::vector<std::string> parameters);
RunGradient gradient_of_run(const Propagated& start, int states, std::vector<std::string> parameters);

namespace detail {

template <DiscreteSystem Sys>
std::unique_ptr<Integrator<Sys>> newton_integrator(const Sys& system, const State<typename Sys::GroupoidType>& start,
                                                   const SensitivityOptions<Sys>& options) {
  const auto configuration = options.configuration.value_or(system.groupoid.unit(start.object));
  return std::make_unique<IntegratorOf<Sys, FixedStepIntegrator<Sys>>>(system, start, configuration,
                                                                       std::make_unique<NewtonStep<Sys>>());
}

/// f(node), a number or a vector of them, as a vector.
template <class Node, class F> std::function<VariedVector(const Node&)> observer_of(F f) {
  return [f = std::move(f)](const Node& node) {
    const auto value = f(node);
    if constexpr (std::is_convertible_v<decltype(value), VariedNumber>) {
      return VariedVector(VariedVector::Constant(1, value));
    } else {
      return VariedVector(value);
    }
  };
}

}  // namespace detail

/// From an integrator of equal steps at its start.
template <DiscreteSystem Sys>
Sensitivities sensitivities(const Sys& system, std::unique_ptr<Integrator<Sys>> integrator,
                            const SensitivityOptions<Sys>& options) {
  const auto momentum = [](const ObservedNode<Sys>& node) { return VariedVector(node.momentum); };
  LinearisedMotionOf<Sys> motion(system, std::move(integrator), options.parameters, momentum);
  const int count = motion.states() + motion.parameters();
  Propagated end = propagate_forward(motion, options.steps, Eigen::MatrixXd::Identity(count, count));
  // The momentum that is reported.
  if (end.converged()) end.end.middleRows(Sys::dimension, Sys::dimension) = end.derivatives;
  return sensitivities_of(end, motion.states(), motion.parameter_names());
}
template <DiscreteSystem Sys>
Sensitivities sensitivities(const Sys& system, const State<typename Sys::GroupoidType>& start,
                            const SensitivityOptions<Sys>& options = {}) {
  return sensitivities<Sys>(system, detail::newton_integrator(system, start, options), options);
}

/// The derivatives of `f`, a function of an ObservedNode that returns a number or a vector of them, observed where the
/// options say: at the end, at a node, or integrated over the run. Taken backwards, from states kept on the way.
///
///     gradient(pendulum, start, [](const auto& node) { return cos(node.object(0)); }, {.steps = 100});
template <DiscreteSystem Sys, class F>
RunGradient gradient(const Sys& system, std::unique_ptr<Integrator<Sys>> integrator, F f,
                     const SensitivityOptions<Sys>& options) {
  LinearisedMotionOf<Sys> motion(system, std::move(integrator), options.parameters,
                                 detail::observer_of<ObservedNode<Sys>>(std::move(f)));
  const Propagated start = propagate_backward(motion, options.steps, options.observed, options.budget);
  return gradient_of_run(start, motion.states(), motion.parameter_names());
}
template <DiscreteSystem Sys, class F>
RunGradient gradient(const Sys& system, const State<typename Sys::GroupoidType>& start, F f,
                     const SensitivityOptions<Sys>& options = {}) {
  return gradient<Sys>(system, detail::newton_integrator(system, start, options), std::move(f), options);
}

}  // namespace lagroid
