#pragma once
/// Steps that keep the discrete energy: the step size h is an unknown, determined by
///
///     F-(g, lambda; h) = mu,    phi(g; h) = 0,    E_d(g, lambda; h) = E_d of the first step.
///
/// The step then adapts to the motion, and the scheme remains symplectic on the phase space extended by time and
/// energy.
///
///     const Kepler kepler;
///     AdaptiveIntegrator<Kepler> orbit(kepler, {{1, 0}, {0, 1.2}}, Pair<2>::unit(Vector<double, 2>(1, 0)),
///                                      std::make_unique<NewtonStep<Kepler>>(),
///                                      std::make_unique<NewtonStep<FreeTime<Kepler>>>());
///     const StepReport report = orbit.advance();
///
/// Requires a Timed system (a Lagrangian for every step size); `h` is the first step. The configuration must end at the
/// initial object (std::invalid_argument). Status, beside those of the solver: `no_step` (no h near the last keeps
/// E_d), `degenerate` (E_d does not depend on h); the option `without_root` chooses another step instead of stopping.
/// [G] Example 6.1

#include <lagroid/core/scalars/compensation.hpp>
#include <lagroid/groupoids/time_extended.hpp>
#include <lagroid/solvers/integrators/cut_step.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/integrators/step_control.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace lagroid {

struct AdaptiveOptions {
  WithoutRoot without_root = WithoutRoot::stop;
  double largest_change = 2;   ///< of the step size, from one step to the next; above 1
  double search_factor = 1.1;  ///< of the step sizes tried in search of a root
};

/// Integrates the free-time system of [G] Example 6.1: each arrow and its step size h solve the equations of momentum
/// and of energy together, E_d(h) = E_d of the first step, which has the given size. Symplectic on the extended phase
/// space and keeps E_d to round-off as long as there is a positive root near the last step.
///
/// For a self-adjoint discretisation E_d = H + a(z) h^2 + ..., and where a(z) changes sign along the motion no positive
/// step keeps E_d: `no_step`, or the step that `without_root` chooses. Where E_d does not depend on h the status is
/// `degenerate`. h = -(last h) always solves the equations of such a scheme: only h > 0 is taken, the root nearest the
/// last step.
///
/// Newton's method solves both equations at once from the continuation of the last steps; where it fails, or ends
/// elsewhere, the steps around the last are searched for a change of sign of E_d(h) - E_d, and it starts again from
/// there. A step that is not solved leaves everything as it was.
template <Timed Sys> class AdaptiveIntegrator {
 public:
  using G = typename Sys::GroupoidType;
  using Extended = FreeTime<Sys>;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint); `system.h` the first step.
  AdaptiveIntegrator(const Sys& system, const State<G>& initial, const ArrowOf<G>& configuration,
                     std::unique_ptr<StepSolver<Sys>> fixed, std::unique_ptr<StepSolver<Extended>> free,
                     AdaptiveOptions options = {})
      : options_(options),
        first_size_(system.h),
        fixed_(system, std::move(fixed)),
        extended_(system),
        free_(std::move(free)),
        trajectory_(system.groupoid, initial, configuration, start_time(system)) {
    if constexpr (HasTimeScale<Sys>)
      if (options.without_root == WithoutRoot::controlled)
        controller_.emplace(system.h, time_scale_rate(system, initial));
  }

  const TrajectoryPoint<Sys>& point() const { return trajectory_.point(); }
  /// Not symplectic at a given h: on the extended phase space it is, as long as there are roots.
  static MethodTraits traits() { return {"adaptive steps", 2, true, false, false}; }
  /// Steps so far whose energy equation had no root.
  long without_root() const { return without_root_; }

  StepReport advance();
  /// A share of the last step from a point, of that size whatever the energy (cut_step.hpp); nothing changes.
  StepReport cut(const TrajectoryPoint<Sys>& from, double share, TrajectoryPoint<Sys>& to) {
    return cut_step(fixed_, from, share * last_size_, to);
  }
  /// Goes on from a point of the same index and time, which no step of its own led to: the next step has the size of
  /// the last one, and the energy that is kept from there on is its own.
  void go_on_from(const TrajectoryPoint<Sys>& point) {
    trajectory_.go_on_from(point);
    fixed_.forget();
    past_.clear();
    time_momentum_compensation_ = {};
    begins_ = true;
    degenerate_ = false;
  }
  /// Visits the systems that its steps are of, to change them; the step's size stays.
  template <class F> void for_each_system(const F& f) {
    f(fixed_.system());
    f(extended_.base);
  }
  /// Visits all that the next step goes on from.
  void serialize(NumberArchive& archive) {
    archive(begins_, last_size_, time_momentum_, time_momentum_compensation_.lost, degenerate_, without_root_);
    fixed_.serialize(archive);
    free_->serialize(archive);
    trajectory_.serialize(fixed_.system().groupoid, archive);
    past_.serialize(archive);
    if (controller_) controller_->serialize(archive);
  }

 private:
  struct Solved {
    StepSolution<Sys> solution;
    double h = 0;
    double time_momentum_change = 0;
  };
  using Unknowns = Vector<double, 1 + Sys::dimension + Sys::constraints>;

  StepReport first_step();
  StepReport next_step();
  StepReport by_newton(double h, const ArrowOf<G>& arrow, const typename Sys::Multipliers& multipliers, Solved& found);
  StepReport by_search(Solved& found);
  StepReport off_the_energy();
  std::optional<double> excess_energy(double h, StepSolution<Sys>& solution);
  void accept(const Solved& found);

  static Step<Extended> extended_step(double h, const Step<Sys>& step) {
    return {{PairArrow<double, 1>{Vector<double, 1>(0.0), Vector<double, 1>(h)}, step.arrow}, step.multipliers};
  }
  /// Their first components are dL/dt at either end of the time.
  GradientsOf<Extended> extended_gradients(double h, const Step<Sys>& step) const {
    const Step<Extended> extended = extended_step(h, step);
    return gradients(extended_, extended.arrow, extended.multipliers);
  }
  bool in_reach(double h) const {
    return h <= options_.largest_change * last_size_ && last_size_ <= options_.largest_change * h;
  }
  bool independent_of_step(double change, double size) const {
    return !(std::abs(change) > 64 * std::numeric_limits<double>::epsilon() * size);
  }

  AdaptiveOptions options_;
  StepReport fixed_report_;  ///< of the last solve of the momentum equation alone
  double first_size_;
  double last_size_ = 0;
  StepPredictor<Sys> fixed_;
  Extended extended_;
  std::unique_ptr<StepSolver<Extended>> free_;
  CompensatedTrajectory<Sys> trajectory_;
  std::optional<StepController> controller_;
  Extrapolation<1 + Sys::dimension + Sys::constraints, 4> past_;
  double time_momentum_ = 0;  ///< p_t = -E_d
  Compensation<double> time_momentum_compensation_{};
  bool begins_ = true;  ///< the next step is of a given size, and its energy is kept
  bool degenerate_ = false;
  int iterations_ = 0;  ///< of all solves since the step began
  long without_root_ = 0;
};

template <Timed Sys> StepReport AdaptiveIntegrator<Sys>::advance() {
  extended_.origin = point().time;
  set_time(fixed_.system(), point().time);
  iterations_ = 0;
  StepReport report = begins_ ? first_step() : next_step();
  report.iterations = iterations_;
  return report;
}

template <Timed Sys> StepReport AdaptiveIntegrator<Sys>::next_step() {
  if (degenerate_) return off_the_energy();
  Solved found;
  StepReport report;
  if (!past_.empty()) {
    const Unknowns predicted = past_.next();
    const AlgebroidVector<G> v = predicted.template segment<Sys::dimension>(1);
    report = by_newton(predicted(0), fixed_.system().groupoid.arrow_in_chart(point().state.object, v),
                       predicted.template tail<Sys::constraints>(), found);
  }
  if (!report.converged()) report = by_search(found);
  if (report.converged()) {
    accept(found);
    return report;
  }
  return options_.without_root == WithoutRoot::stop ? report : off_the_energy();
}

/// The step of the given size, or after a change of the last one, from which the energy is taken.
template <Timed Sys> StepReport AdaptiveIntegrator<Sys>::first_step() {
  Solved found;
  found.h = point().index == 0 ? first_size_ : last_size_;
  fixed_.system().h = found.h;
  StepReport report = fixed_.solve(point().state, found.solution);
  iterations_ += report.iterations;
  if (!report.converged()) return report;
  const Step<Sys>& step = found.solution.step;
  const auto d = extended_gradients(found.h, step);
  time_momentum_ = -d.source_gradient(0);
  found.time_momentum_change = d.source_gradient(0) + d.target_gradient(0);

  StepSolution<Sys> halved;
  const auto change = excess_energy(0.5 * found.h, halved);
  fixed_.system().h = found.h;
  fixed_.forget();
  const double power = std::abs(point().state.momentum.dot(fixed_.system().groupoid.tau_inverse(step.arrow))) / found.h;
  if (change && independent_of_step(*change, std::abs(time_momentum_) + power)) {
    if (options_.without_root == WithoutRoot::stop) {
      report.status = SolveStatus::degenerate;
      return report;
    }
    degenerate_ = true;
  }
  accept(found);
  return report;
}

/// Both equations at once; `left_domain` where the root is another than the one near the last step.
template <Timed Sys>
StepReport AdaptiveIntegrator<Sys>::by_newton(double h, const ArrowOf<G>& arrow,
                                              const typename Sys::Multipliers& multipliers, Solved& found) {
  State<typename Extended::GroupoidType> state;
  state.object = {Vector<double, 1>(0.0), point().state.object};
  state.momentum << time_momentum_, point().state.momentum;
  StepSolution<Extended> solution;
  solution.step = extended_step(h, {arrow, multipliers});
  StepReport report = free_->solve(extended_, state, solution);
  iterations_ += report.iterations;
  if (!report.converged()) return report;
  const auto& [time, solved] = solution.step.arrow;
  found.h = time.target(0);
  found.solution.step = {solved, solution.step.multipliers};
  found.solution.momentum_change = solution.momentum_change.template tail<Sys::dimension>();
  // Of the next correction, most lies along the motion, where h is ill determined: the arrow is not corrected by it.
  found.solution.remainder.setZero();
  found.time_momentum_change = solution.momentum_change(0);
  if (!in_reach(found.h)) report.status = SolveStatus::left_domain;
  return report;
}

/// E_d(h) - E_d on the step of the momentum equation alone; nothing where that is not solved.
template <Timed Sys>
std::optional<double> AdaptiveIntegrator<Sys>::excess_energy(double h, StepSolution<Sys>& solution) {
  fixed_.system().h = h;
  fixed_.forget();
  fixed_report_ = fixed_.solve(point().state, solution);
  iterations_ += fixed_report_.iterations;
  if (!fixed_report_.converged()) return std::nullopt;
  const double excess = time_momentum_ + extended_gradients(h, solution.step).source_gradient(0);
  return std::isfinite(excess) ? std::optional(excess) : std::nullopt;
}

/// The root nearest the last step by the sign of E_d(h) - E_d on a ladder of steps around it, bisection, and Newton. A
/// change of sign without a root (E_d jumps there) is `no_step` as well.
template <Timed Sys> StepReport AdaptiveIntegrator<Sys>::by_search(Solved& found) {
  StepSolution<Sys> solution;
  const auto centre = excess_energy(last_size_, solution);
  if (!centre) return fixed_report_;
  const auto refine = [&](double from, double excess_from, double to) -> StepReport {
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = 0.5 * (from + to);
      const auto excess = excess_energy(middle, solution);
      if (!excess) return fixed_report_;
      const StepReport report = by_newton(middle, solution.step.arrow, solution.step.multipliers, found);
      if (report.converged() && std::min(from, to) <= found.h && found.h <= std::max(from, to)) return report;
      ((*excess > 0) == (excess_from > 0) ? from : to) = middle;
    }
    return {SolveStatus::no_step};
  };
  const double highest = options_.largest_change * last_size_;
  const double lowest = last_size_ / options_.largest_change;
  double up = last_size_;
  double down = last_size_;
  double excess_up = *centre;
  double excess_down = *centre;
  while (up < highest) {
    const double next_up = std::min(up * options_.search_factor, highest);
    const double next_down = std::max(down / options_.search_factor, lowest);
    const auto higher = excess_energy(next_up, solution);
    if (higher && (*higher > 0) != (excess_up > 0)) return refine(up, excess_up, next_up);
    const auto lower = excess_energy(next_down, solution);
    if (lower && (*lower > 0) != (excess_down > 0)) return refine(down, excess_down, next_down);
    if (!higher || !lower) break;
    up = next_up;
    down = next_down;
    excess_up = *higher;
    excess_down = *lower;
  }
  return {SolveStatus::no_step};
}

/// A step that does not keep E_d, as the options say.
template <Timed Sys> StepReport AdaptiveIntegrator<Sys>::off_the_energy() {
  Solved found;
  found.h = controller_ && controller_->step() > 0 ? controller_->step() : first_size_;
  fixed_.system().h = found.h;
  fixed_.forget();
  const StepReport report = fixed_.solve(point().state, found.solution);
  iterations_ += report.iterations;
  if (!report.converged()) return report;
  const auto d = extended_gradients(found.h, found.solution.step);
  found.time_momentum_change = d.source_gradient(0) + d.target_gradient(0);
  past_.clear();
  accept(found);
  ++without_root_;
  return report;
}

template <Timed Sys> void AdaptiveIntegrator<Sys>::accept(const Solved& found) {
  const auto& groupoid = fixed_.system().groupoid;
  begins_ = false;
  trajectory_.join(groupoid, found.solution);
  trajectory_.arrive(found.h);
  last_size_ = found.h;
  time_momentum_compensation_.add(time_momentum_, found.time_momentum_change);
  Unknowns unknowns;
  unknowns << found.h, groupoid.chart(found.solution.step.arrow), found.solution.step.multipliers;
  past_.push(unknowns);
  if constexpr (HasTimeScale<Sys>)
    if (controller_) {
      const double rate = time_scale_rate(fixed_.system(), point().state);
      controller_->pass(rate, found.h);
      if (!(controller_->step() > 0)) controller_.emplace(found.h, rate);  // too fast a change: control begins anew
    }
}

}  // namespace lagroid
