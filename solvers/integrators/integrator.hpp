#pragma once
/// Integrators of initial values by a method chosen at run time: (q_k, mu_k) -> (q_{k+1}, mu_{k+1}), k = 0, 1, ...
/// Scenes, Python and studies choose the method by options; loop, ledger and output then need one interface only.
///
///     const Kepler kepler;
///     const State<Pair<2>> start{{1, 0}, {0, 1}};
///     auto integrator = make_integrator(kepler, start, Pair<2>::unit(start.object), {.fixed = StepKind::splitting});
///     while (integrator->point().time < 10 && integrator->advance().converged()) {}
///
/// Requires a configuration that ends at the initial object, and of the system what the method uses. `make_integrator`
/// throws std::invalid_argument where the system has not got that (the message names the member) or the configuration
/// ends elsewhere; `advance` reports a SolveStatus, and where it is not `converged` the point stays as it was.

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/quantity.hpp>
#include <lagroid/solvers/integrators/compositions.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <functional>
#include <memory>
#include <vector>

namespace lagroid {

/// How time goes on.
enum class TimeMode {
  fixed,        ///< by equal steps, each perhaps composed of several (CompositionIntegrator)
  adaptive,     ///< by steps that keep the discrete energy (AdaptiveIntegrator)
  controlled,   ///< by steps in proportion to the system's time scale, reversibly (ControlledIntegrator)
  prescribed,   ///< by steps that are a function of the arrow, h(g) (PrescribedIntegrator)
  transformed,  ///< by explicit steps that are equal in another time, composed (TransformedIntegrator)
};

/// What becomes of an adaptive step whose energy equation has no root.
enum class WithoutRoot {
  stop,        ///< the motion ends there, with a typed status
  constant,    ///< that step has the size of the first
  controlled,  ///< that step has the size a StepController gives; for systems with a time scale
};

/// How a fixed step is made.
enum class StepKind {
  variational,    ///< implicitly, from the discrete Lagrangian
  splitting,      ///< explicitly, of the flows of a SplitSystem
  extrapolation,  ///< explicitly, by splitting steps extrapolated to none, as many as a tolerance asks for
  runge_kutta,    ///< explicitly, of the rates of a system, by the classical method: to compare with, it keeps nothing
};

struct IntegratorOptions {
  TimeMode mode = TimeMode::fixed;
  StepKind fixed = StepKind::variational;
  Composition composition = compositions::single;  ///< of fixed steps
  double tolerance = 0;                            ///< of extrapolation: of an inner step, relative to the motion
  WithoutRoot without_root = WithoutRoot::stop;    ///< of adaptive ones
  StepMethod method = StepMethod::newton;
  StepOptions step = {};
};

/// A trajectory in the making. A step that does not converge leaves everything as it was.
template <DiscreteSystem Sys> class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual StepReport advance() = 0;
  virtual const TrajectoryPoint<Sys>& point() const = 0;
  /// Of the method for a variational system.
  virtual MethodTraits traits() const = 0;
  /// The arrows before the last that make up the last step, where there are any: each with its start and its size.
  using Visit = std::function<void(const Step<Sys>&, double start, double size)>;
  virtual void for_each_inner_stage(const Visit&) const {}
  /// Whether steps can be made in part.
  virtual bool cuts() const { return false; }
  /// Keeps this node, from which the next step can be made in part.
  virtual void keep_node() {}
  /// The point that a share of the last step, 0 to 1, leads to from the node that was kept before it, by a step of the
  /// same method, whose arrows before the last are visited. Nothing else changes, and nothing at all where it does not
  /// converge.
  virtual StepReport cut(double /*share*/, TrajectoryPoint<Sys>& /*to*/, const Visit& /*inner*/ = {}) { return {}; }
  /// Whether the momentum can be changed inside of a step.
  virtual bool kicks() const { return false; }
  /// Adds to the momentum where a share of the last step leads to, and makes the rest of the step from there, which is
  /// from now on the step that is cut. It stays at this node, in another state; where the rest does not converge, in
  /// the one that it had.
  virtual StepReport kick(double /*share*/, const AlgebroidVector<typename Sys::GroupoidType>& /*by*/) { return {}; }
  /// Whether the system can be changed inside of a step.
  virtual bool changes_system() const { return false; }
  /// Changes the system where a share of the last step leads to, and makes the rest of the step by it, as `kick` does.
  using ChangeSystem = std::function<void(Sys&)>;
  virtual StepReport change(double /*share*/, const ChangeSystem& /*how*/) { return {}; }
  /// Changes the system at this node, where all that a step remembers is of the changed one.
  virtual void change_here(const ChangeSystem& /*how*/) {}
  /// Steps so far whose size is not that of the mode.
  virtual long without_root() const { return 0; }
  /// Visits all that the next step goes on from: an integrator begun with the same arguments, to which it is restored,
  /// goes on with the same bits.
  virtual void serialize(NumberArchive& archive) = 0;
};

namespace detail {

/// All integrators of a system by their names: complete where `integrator_methods.hpp` is included.
template <DiscreteSystem Sys> struct Integrators;

}  // namespace detail

/// An integrator from a state; `system.h` is the step, or the first. Requires a Timed system for any mode but fixed,
/// one with a time scale for controlled steps and with one of its arrows for prescribed steps, a SplitSystem for
/// splitting and extrapolation, an AttractiveSystem for a transformed time, one that HasRates for Runge-Kutta steps and
/// a variational one with a step `h` for orders above two (throws std::invalid_argument). Include
/// `integrator_methods.hpp` for a system of your own; those of `systems/` are compiled.
template <DiscreteSystem Sys>
std::unique_ptr<Integrator<Sys>> make_integrator(const Sys& system, const State<typename Sys::GroupoidType>& initial,
                                                 const ArrowOf<typename Sys::GroupoidType>& configuration,
                                                 const IntegratorOptions& options) {
  constexpr bool included = requires { sizeof(detail::Integrators<Sys>); };
  static_assert(
      included,
      "include <lagroid/solvers/integrators/integrator_methods.hpp> to integrate a system of your own by name");
  if constexpr (included) return detail::Integrators<Sys>::make(system, initial, configuration, options);
}

/// The step size at which one step and two of half its size differ, relative to the motion over the step, by
/// `accuracy`, up to a tenth; searched from system.h, and at most about a thousand times as large. Momenta are taken as
/// they are reported. Zero where no such step was found.
template <DiscreteSystem Sys>
double step_for_accuracy(const Sys& system, const State<typename Sys::GroupoidType>& initial, double accuracy,
                         const IntegratorOptions& options) {
  constexpr bool included = requires { sizeof(detail::Integrators<Sys>); };
  static_assert(
      included,
      "include <lagroid/solvers/integrators/integrator_methods.hpp> to find the step of a system of your own");
  if constexpr (included) return detail::Integrators<Sys>::step_for_accuracy(system, initial, accuracy, options);
}

}  // namespace lagroid
