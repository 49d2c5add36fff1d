#pragma once
/// Steps whose size is a function of the arrow, t1 - t0 = h(g) = epsilon sigma(g), solved with its derivatives in the
/// equations of motion:
///
///     F-(g, lambda; h) - nu (dh)-(g) = mu,    -E_d(g, lambda; h) + nu = p_t,    phi(g; h) = 0,    t1 - t0 = h(g),
///
/// (dh)- being the derivative of h by the source, along the fibre. They are short where the motion is fast, as
/// controlled steps are, but the map is symplectic, on the phase space extended by time and its momentum p_t. That is
/// kept where L does not depend on time; as nu = 0 on the first arrow, nu = E_d - (E_d of the first), of the size of
/// the discretisation's error. To leading order it is the motion of sigma (H - E), E the energy at the start, in a time
/// of its own.
///
///     const Kepler kepler;
///     PrescribedIntegrator<Kepler> orbit(
///         kepler, {{1, 0}, {0, 1.2}}, Pair<2>::unit(Vector<double, 2>(1, 0)), std::make_unique<NewtonStep<Kepler>>(),
///         std::make_unique<NewtonStep<PrescribedStep<Kepler, TimeScaleStep>>>());
///     const StepReport report = orbit.advance();
///
/// Requires a Timed system with a `time_scale` of its arrows; `h` is the first step, which determines epsilon. The
/// configuration must end at the initial object (std::invalid_argument). Status, beside those of the solver: `no_step`
/// where sigma of the first arrow is not a positive number, `left_domain` where the size of a step would change by more
/// than a factor of two, which a step that resolves the motion does not do. A step that is not solved leaves everything
/// as it was.
/// [G], after Example 6.2

#include <lagroid/core/capabilities/time_scale_of_arrows.hpp>
#include <lagroid/core/scalars/compensation.hpp>
#include <lagroid/groupoids/time_extended.hpp>
#include <lagroid/solvers/integrators/compensated_trajectory.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/extrapolation.hpp>
#include <lagroid/solvers/step/step_predictor.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace lagroid {

template <HasTimeScaleOfArrows Sys> class PrescribedIntegrator {
 public:
  using G = typename Sys::GroupoidType;
  using Extended = PrescribedStep<Sys, TimeScaleStep>;

  /// `first` solves the first step, which has the given size, `prescribed` all others.
  PrescribedIntegrator(const Sys& system, const State<G>& initial, const ArrowOf<G>& configuration,
                       std::unique_ptr<StepSolver<Sys>> first, std::unique_ptr<StepSolver<Extended>> prescribed)
      : first_(system, std::move(first)),
        extended_(system, TimeScaleStep{}),
        prescribed_(std::move(prescribed)),
        trajectory_(system.groupoid, initial, configuration, start_time(system)) {}

  const TrajectoryPoint<Sys>& point() const { return trajectory_.point(); }
  /// Symplectic on the extended phase space; symmetric where sigma(g^{-1}) = sigma(g).
  static MethodTraits traits() { return {"prescribed steps", 2, true, false, false}; }
  /// p_t, which is kept where the system does not depend on time.
  double momentum_of_time() const { return time_momentum_; }
  /// nu of the last arrow.
  double step_multiplier() const { return step_multiplier_; }

  StepReport advance() {
    extended_.origin = point().time;
    return extended_.step_size.epsilon > 0 ? next_step() : first_step();
  }

  /// Visits all that the next step goes on from.
  void serialize(NumberArchive& archive) {
    archive(extended_.step_size.epsilon, time_momentum_, compensation_.lost, step_multiplier_);
    first_.serialize(archive);
    prescribed_->serialize(archive);
    trajectory_.serialize(first_.system().groupoid, archive);
    past_.serialize(archive);
  }

 private:
  static constexpr int phis = Sys::arrow_constraints;
  static constexpr double largest_change = 2;  ///< of the step size, from one step to the next, as of adaptive steps
  using ExtendedMultipliers = typename Extended::Multipliers;
  using Unknowns = Vector<double, 1 + Sys::dimension + Extended::constraints>;

  static Step<Extended> extended_step(double h, const ArrowOf<G>& arrow, const ExtendedMultipliers& multipliers) {
    return {{PairArrow<double, 1>{Vector<double, 1>(0.0), Vector<double, 1>(h)}, arrow}, multipliers};
  }

  /// Of the given size, with nu = 0: it says what epsilon is, and p_t.
  StepReport first_step() {
    Sys& system = first_.system();
    set_time(system, point().time);
    StepSolution<Sys> solution;
    StepReport report = first_.solve(point().state, solution);
    if (!report.converged()) return report;
    const auto& [arrow, of_base] = solution.step;
    const double scale = system.time_scale(arrow);
    if (!(scale > 0 && std::isfinite(scale))) {
      first_.forget();
      report.status = SolveStatus::no_step;
      return report;
    }
    extended_.step_size.epsilon = system.h / scale;
    ExtendedMultipliers multipliers;
    multipliers << of_base.template head<phis>(), 0.0, of_base.template tail<Sys::object_constraints>();
    const Step<Extended> step = extended_step(system.h, arrow, multipliers);
    const auto d = gradients(extended_, step.arrow, step.multipliers);
    time_momentum_ = -d.source_gradient(0);
    accept(system.h, solution, multipliers, d.source_gradient(0) + d.target_gradient(0));
    return report;
  }

  StepReport next_step() {
    const auto& groupoid = first_.system().groupoid;
    const Unknowns predicted = past_.next();
    State<typename Extended::GroupoidType> state;
    state.object = {Vector<double, 1>(0.0), point().state.object};
    state.momentum << time_momentum_, point().state.momentum;
    StepSolution<Extended> solution;
    const AlgebroidVector<G> v = predicted.template segment<Sys::dimension>(1);
    solution.step = extended_step(predicted(0), groupoid.arrow_in_chart(point().state.object, v),
                                  predicted.template tail<Extended::constraints>());
    StepReport report = prescribed_->solve(extended_, state, solution);
    if (!report.converged()) return report;
    const auto& [time, arrow] = solution.step.arrow;
    const double change = time.target(0) / point().step_size;
    if (std::max(change, 1 / change) > largest_change) {
      report.status = SolveStatus::left_domain;
      return report;
    }
    // Without the remainder: most of it lies along the motion, where the size of the step follows it.
    StepSolution<Sys> of_base;
    of_base.step.arrow = arrow;
    of_base.step.multipliers << solution.step.multipliers.template head<phis>(),
        solution.step.multipliers.template tail<Sys::object_constraints>();
    of_base.momentum_change = solution.momentum_change.template tail<Sys::dimension>();
    accept(time.target(0), of_base, solution.step.multipliers, solution.momentum_change(0));
    return report;
  }

  void accept(double h, const StepSolution<Sys>& found, const ExtendedMultipliers& multipliers, double change) {
    const auto& groupoid = first_.system().groupoid;
    trajectory_.join(groupoid, found);
    trajectory_.arrive(h);
    compensation_.add(time_momentum_, change);
    step_multiplier_ = multipliers(phis);
    Unknowns unknowns;
    unknowns << h, groupoid.chart(found.step.arrow), multipliers;
    past_.push(unknowns);
  }

  StepPredictor<Sys> first_;
  Extended extended_;
  std::unique_ptr<StepSolver<Extended>> prescribed_;
  CompensatedTrajectory<Sys> trajectory_;
  Extrapolation<1 + Sys::dimension + Extended::constraints, 4> past_;
  double time_momentum_ = 0;
  Compensation<double> compensation_{};
  double step_multiplier_ = 0;
};

}  // namespace lagroid
