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
        trajectory_(system.groupoid, initial, configuration, start_time(system)),
        symmetric_(scale_is_symmetric(system, initial.object)) {}

  const TrajectoryPoint<Sys>& point() const { return trajectory_.point(); }
  /// Symplectic on the extended phase space; symmetric where sigma(g^{-1}) = sigma(g), of an arrow from the start.
  MethodTraits traits() const { return {"prescribed steps", 2, symmetric_, false, false}; }
  /// p_t, which is kept where the system does not depend on time.
  double momentum_of_time() const { return time_momentum_; }
  /// nu of the last arrow.
  double step_multiplier() const { return multipliers_(phis); }

  StepReport advance() {
    extended_.origin = point().time;
    return extended_.step_size.epsilon > 0 ? next_step() : first_step();
  }

  /// A share of the last step from the point before it: the prescribed step of that share of epsilon. Nothing changes.
  [[gnu::cold]] StepReport cut(const TrajectoryPoint<Sys>& from, double share, TrajectoryPoint<Sys>& to) {
    NumberArchive kept;
    prescribed_->serialize(kept);
    const double epsilon = extended_.step_size.epsilon;
    const double expected = share * point().step_size;
    extended_.step_size.epsilon = share * epsilon;
    extended_.origin = from.time;
    const auto& groupoid = first_.system().groupoid;
    const AlgebroidVector<G> v = share * groupoid.chart(point().step.arrow);
    Found found;
    StepReport report = solve(from.state, time_momentum_before_, expected, v, multipliers_, found);
    extended_.step_size.epsilon = epsilon;
    NumberArchive restored(kept.numbers());
    prescribed_->serialize(restored);
    if (report.converged() && !is_near(found.h, expected)) report.status = SolveStatus::left_domain;
    if (!report.converged()) return report;
    CompensatedTrajectory<Sys> trajectory(groupoid, from.state, from.configuration, from.time);
    trajectory.join(groupoid, found.solution);
    trajectory.arrive_at(from.time + found.h, found.h);
    const long index = from.index + 1;
    to = trajectory.point();
    to.index = index;
    return report;
  }
  /// Visits all that the next step goes on from.
  void serialize(NumberArchive& archive) {
    archive(extended_.step_size.epsilon, time_momentum_, compensation_.lost, time_momentum_before_, multipliers_);
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

  static bool scale_is_symmetric(const Sys& system, const ObjectOf<G>& q) {
    AlgebroidVector<G> v;
    for (int i = 0; i < Sys::dimension; ++i) v(i) = 0.01 * (i + 1);
    const ArrowOf<G> g = system.groupoid.arrow_in_chart(q, v);
    const double scale = system.time_scale(g);
    return std::abs(system.time_scale(system.groupoid.inverse(g)) - scale) <= 1e-12 * std::abs(scale);
  }

  /// Of the given size, with nu = 0: it says what epsilon is, and p_t.
  StepReport first_step() {
    Sys& system = first_.system();
    set_time(system, point().time);
    Found found{.h = system.h, .solution = {}, .multipliers = {}};
    StepReport report = first_.solve(point().state, found.solution);
    if (!report.converged()) return report;
    const auto& [arrow, of_base] = found.solution.step;
    const double scale = system.time_scale(arrow);
    if (!(scale > 0 && std::isfinite(scale))) {
      first_.forget();
      report.status = SolveStatus::no_step;
      return report;
    }
    extended_.step_size.epsilon = system.h / scale;
    found.multipliers << of_base.template head<phis>(), 0.0, of_base.template tail<Sys::object_constraints>();
    const Step<Extended> step = extended_step(system.h, arrow, found.multipliers);
    const auto d = gradients(extended_, step.arrow, step.multipliers);
    time_momentum_ = -d.source_gradient(0);
    found.time_momentum_change = d.source_gradient(0) + d.target_gradient(0);
    accept(found);
    return report;
  }

  StepReport next_step() {
    const Unknowns predicted = past_.next();
    const AlgebroidVector<G> v = predicted.template segment<Sys::dimension>(1);
    Found found;
    StepReport report =
        solve(point().state, time_momentum_, predicted(0), v, predicted.template tail<Extended::constraints>(), found);
    if (report.converged() && !is_near(found.h, point().step_size)) report.status = SolveStatus::left_domain;
    if (report.converged()) accept(found);
    return report;
  }

  struct Found {
    double h = 0;
    StepSolution<Sys> solution;
    ExtendedMultipliers multipliers;
    double time_momentum_change = 0;
  };
  /// The step from a state and p_t, from a guess of its size, its arrow in the groupoid's chart and its multipliers.
  StepReport solve(const State<G>& from, double time_momentum, double h, const AlgebroidVector<G>& v,
                   const ExtendedMultipliers& multipliers, Found& found) {
    State<typename Extended::GroupoidType> state;
    state.object = {Vector<double, 1>(0.0), from.object};
    state.momentum << time_momentum, from.momentum;
    StepSolution<Extended> solution;
    solution.step = extended_step(h, first_.system().groupoid.arrow_in_chart(from.object, v), multipliers);
    const StepReport report = prescribed_->solve(extended_, state, solution);
    if (!report.converged()) return report;
    found.h = std::get<0>(solution.step.arrow).target(0);
    found.multipliers = solution.step.multipliers;
    found.time_momentum_change = solution.momentum_change(0);
    // Without the remainder: most of it lies along the motion, where the size of the step follows it.
    found.solution.step.arrow = std::get<1>(solution.step.arrow);
    found.solution.step.multipliers << found.multipliers.template head<phis>(),
        found.multipliers.template tail<Sys::object_constraints>();
    found.solution.momentum_change = solution.momentum_change.template tail<Sys::dimension>();
    return report;
  }
  static bool is_near(double h, double expected) {
    const double change = h / expected;
    return change <= largest_change && 1 <= largest_change * change;
  }

  void accept(const Found& found) {
    const auto& groupoid = first_.system().groupoid;
    trajectory_.join(groupoid, found.solution);
    trajectory_.arrive(found.h);
    time_momentum_before_ = time_momentum_;
    compensation_.add(time_momentum_, found.time_momentum_change);
    multipliers_ = found.multipliers;
    Unknowns unknowns;
    unknowns << found.h, groupoid.chart(found.solution.step.arrow), found.multipliers;
    past_.push(unknowns);
  }

  StepPredictor<Sys> first_;
  Extended extended_;
  std::unique_ptr<StepSolver<Extended>> prescribed_;
  CompensatedTrajectory<Sys> trajectory_;
  bool symmetric_;
  Extrapolation<1 + Sys::dimension + Extended::constraints, 4> past_;
  double time_momentum_ = 0;
  Compensation<double> compensation_{};
  double time_momentum_before_ = 0;  ///< of the last step
  ExtendedMultipliers multipliers_ = ExtendedMultipliers::Zero();
};

}  // namespace lagroid
