#pragma once
/// Reversible control of the step size by a time scale sigma(z) of the system:
///
///     rho_{k+1/2} = rho_{k-1/2} - epsilon (d log sigma / dt)(z_k),    h_{k+1/2} = epsilon / rho_{k+1/2}.
///
/// Steps become short where the motion is fast, and a symmetric method stays reversible, as it does not under the usual
/// control by error estimates.
///
///     const Kepler kepler;
///     ControlledIntegrator<Kepler> orbit(kepler, {{1, 0}, {0, 1.2}}, Pair<2>::unit(Vector<double, 2>(1, 0)),
///                                        std::make_unique<NewtonStep<Kepler>>());
///     const StepReport report = orbit.advance();
///
/// Requires a Timed system with a `time_scale_rate`; `h` is the first step. The configuration must end at the initial
/// object (std::invalid_argument). Status, beside those of the solver: `no_step` where the motion changes too fast for
/// epsilon. (Hairer and Soderlind 2005; Hairer, Lubich, Wanner VIII.3.2.)

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/capabilities/time_scale.hpp>
#include <lagroid/solvers/generating/constrained_momentum.hpp>
#include <lagroid/solvers/integrators/compensated_trajectory.hpp>
#include <lagroid/solvers/integrators/cut_step.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_predictor.hpp>

#include <memory>
#include <utility>

namespace lagroid {

/// The rate at a state on its way, whose momentum may leave the object constraints.
template <HasTimeScale Sys> double time_scale_rate(const Sys& system, const State<typename Sys::GroupoidType>& state) {
  return system.time_scale_rate({state.object, tangent_momentum(system, state)});
}

/// The integrating controller of Hairer and Soderlind (SIAM J. Sci. Comput. 26, 2005; Hairer, Lubich, Wanner VIII.3.2):
/// a density rho of steps with
///
///     rho_{k+1/2} = rho_{k-1/2} - epsilon (d log sigma / dt)(z_k),    h_{k+1/2} = epsilon / rho_{k+1/2},
///
/// so that h follows sigma(z(t)) without evaluating it. The steps are those of a symmetric splitting of (z, rho), hence
/// reversible when the method is symmetric; they are not symplectic.
class StepController {
 public:
  /// `first_step` is the step at the start, up to the change over its first half; `rate` is that of the first state.
  StepController(double first_step, double rate) : epsilon_(first_step), density_(1 - 0.5 * first_step * rate) {}

  /// The step from the present state; not positive where the motion changes too fast for this epsilon.
  double step() const { return epsilon_ / density_; }
  /// Moves on to a state with this rate, by a step of this size: epsilon / rho, unless another was taken.
  void pass(double rate, double size) { density_ -= density_ * size * rate; }
  void serialize(NumberArchive& archive) { archive(epsilon_, density_); }

 private:
  double epsilon_;
  double density_;
};

/// Integrates with steps from a StepController. A step that does not converge leaves everything as it was.
template <Timed Sys>
requires HasTimeScale<Sys>
class ControlledIntegrator {
 public:
  using G = typename Sys::GroupoidType;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint); `system.h` the first step.
  ControlledIntegrator(Sys system, const State<G>& initial, const ArrowOf<G>& configuration,
                       std::unique_ptr<StepSolver<Sys>> solver)
      : predictor_(std::move(system), std::move(solver)),
        trajectory_(predictor_.system().groupoid, initial, configuration, start_time(predictor_.system())),
        controller_(predictor_.system().h, time_scale_rate(predictor_.system(), initial)) {}

  const TrajectoryPoint<Sys>& point() const { return trajectory_.point(); }
  static MethodTraits traits() { return {"controlled steps", 2, true, false, false}; }

  StepReport advance() {
    Sys& system = predictor_.system();
    const double size = controller_.step();
    if (!(size > 0)) return {SolveStatus::no_step};
    system.h = size;
    set_time(system, point().time);
    StepSolution<Sys> solution;
    const StepReport report = predictor_.solve(point().state, solution);
    if (!report.converged()) return report;
    trajectory_.join(system.groupoid, solution);
    trajectory_.arrive(system.h);
    before_ = controller_;
    controller_.pass(time_scale_rate(system, point().state), system.h);
    return report;
  }

  /// A share of the last step from a point, by the same equations (cut_step.hpp); nothing changes.
  StepReport cut(const TrajectoryPoint<Sys>& from, double share, TrajectoryPoint<Sys>& to) {
    return cut_step(predictor_, from, share * predictor_.system().h, to);
  }
  /// Goes on from a point of the same index and time, which no step of its own led to; the next step follows the time
  /// scale there.
  void go_on_from(const TrajectoryPoint<Sys>& point) {
    trajectory_.go_on_from(point);
    predictor_.forget();
    controller_ = before_;
    controller_.pass(time_scale_rate(predictor_.system(), point.state), predictor_.system().h);
  }
  /// Visits the system that its steps are of, to change it; the step's size stays.
  template <class F> void for_each_system(const F& f) {
    f(predictor_.system());
    predictor_.forget();
  }
  /// Visits all that the next step goes on from.
  void serialize(NumberArchive& archive) {
    predictor_.serialize(archive);
    trajectory_.serialize(predictor_.system().groupoid, archive);
    controller_.serialize(archive);
  }

 private:
  StepPredictor<Sys> predictor_;
  CompensatedTrajectory<Sys> trajectory_;
  StepController controller_;
  StepController before_ = controller_;  ///< the last step
};

}  // namespace lagroid
