#pragma once
/// Boundary values whose step sizes are a function of the arrow. [G], after Example 6.2

#include <lagroid/core/capabilities/time_scale_of_arrows.hpp>
#include <lagroid/groupoids/time_extended.hpp>
#include <lagroid/solvers/boundary/boundary_kkt.hpp>
#include <lagroid/solvers/boundary/times/timed_path.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace lagroid {

namespace detail {

/// Newton's method on all equations of a path whose steps are prescribed.
template <HasTimeScaleOfArrows Sys> class PrescribedStepsNewton {
 public:
  using Extended = PrescribedStep<Sys, TimeScaleStep>;

  explicit PrescribedStepsNewton(const BoundaryProblem<Extended>& problem, Path<Extended> path)
      : problem_(problem), path_(std::move(path)) {}

  /// Solves with that epsilon, from the path as it is.
  SolveStatus solve(double epsilon, int max_iterations) {
    problem_.system.step_size.epsilon = epsilon;
    evaluate();
    for (int k = 0; k < max_iterations; ++k, ++iterations_) {
      if (!std::isfinite(residual_)) return SolveStatus::not_finite;
      const double before = residual_;
      const Path<Extended> kept = path_;
      advance();
      if (before <= tolerance && !(residual_ < 0.5 * before)) {
        if (!(residual_ <= before)) path_ = kept;
        evaluate();
        return admissible() ? SolveStatus::converged : SolveStatus::left_domain;
      }
    }
    return SolveStatus::not_converged;
  }

  /// sum_k nu_k sigma(g_k), nu the multipliers of the steps: minus the derivative of the action by epsilon.
  double slope() const {
    double sum = 0;
    for (const auto& step : path_)
      sum += step.multipliers(Sys::arrow_constraints) * problem_.system.base.time_scale(std::get<1>(step.arrow));
    return sum;
  }
  const Path<Extended>& path() const { return path_; }
  double residual() const { return residual_; }
  int iterations() const { return iterations_; }
  /// Of the nodes, time's left out.
  std::vector<AlgebroidVector<typename Sys::GroupoidType>> momenta() const {
    std::vector<AlgebroidVector<typename Sys::GroupoidType>> out{
        legendre_minus(problem_.system, path_.front()).momentum.template tail<Sys::dimension>()};
    for (const auto& step : path_)
      out.push_back(legendre_plus(problem_.system, step).momentum.template tail<Sys::dimension>());
    return out;
  }
  double momentum_of_time() const { return legendre_minus(problem_.system, path_.front()).momentum(0); }
  double cost() const { return action(problem_.system, path_); }
  Classification classify() {
    evaluate();
    return kkt_.classify(problem_.system, path_);
  }

 private:
  static constexpr double tolerance = 1e-10;

  void evaluate() {
    kkt_.evaluate(problem_.system, path_);
    kkt_.choose_scale();
    residual_ = kkt_.residual_norm();
  }
  void advance() {
    kkt_.newton_side(side_);
    kkt_.factor(0, 0);
    kkt_.solve_in_place(side_);
    kkt_.unscale(side_, variation_);
    displace(problem_, path_, variation_, 1.0, trial_);
    std::swap(path_, trial_);
    evaluate();
  }
  bool admissible() const {
    return std::all_of(path_.begin(), path_.end(),
                       [&](const auto& step) { return problem_.system.admissible(step.arrow); });
  }

  BoundaryProblem<Extended> problem_;
  Path<Extended> path_;
  Path<Extended> trial_;
  BoundaryKkt<Extended> kkt_;
  typename BoundaryKkt<Extended>::Columns side_;
  Variation<Extended> variation_;
  double residual_ = 0;
  int iterations_ = 0;
};

}  // namespace detail

/// Of all paths that make up the arrow `boundary` in the time of `start`, with steps t1 - t0 = epsilon sigma(g), one
/// that makes the action stationary, by epsilon too: so many steps fill the time for one epsilon alone, and any other
/// would bend the motion. `start` is a solution with other steps, equal ones for instance.
///
/// The multipliers nu of the steps enter the equations of motion, d/dg of nu h(g), and say how far these steps are from
/// those that keep the energy: -E_d + nu is the momentum of time, the same on all arrows. As epsilon is free, the nu
/// have mean zero over the time and are of the size of the discretisation's error; `energy` is minus that momentum.
template <HasTimeScaleOfArrows Sys>
TimedSolution<Sys> solve_prescribed_steps(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& boundary,
                                          const TimedSolution<Sys>& start, int max_iterations = 50) {
  using Newton = detail::PrescribedStepsNewton<Sys>;
  using Extended = typename Newton::Extended;
  const double duration = start.times.back() - start.times.front();
  BoundaryProblem<Extended> problem{Extended(system, TimeScaleStep{}), timed_boundary<Sys>(boundary, 0, duration, 1)};
  problem.system.origin = start.times.front();

  double scales = 0;
  for (const auto& step : start.path) scales += system.time_scale(step.arrow);
  double epsilon = duration / scales;
  Path<Extended> path;
  double time = 0;
  for (const auto& step : start.path) {
    const double next =
        path.size() + 1 == start.path.size() ? duration : time + epsilon * system.time_scale(step.arrow);
    constexpr int phis = Sys::arrow_constraints;
    typename Extended::Multipliers multipliers = Extended::Multipliers::Zero();
    multipliers.template head<phis>() = step.multipliers.template head<phis>();
    multipliers.template tail<Sys::object_constraints>() = step.multipliers.template tail<Sys::object_constraints>();
    path.push_back({{PairArrow<double, 1>{Vector<double, 1>(time), Vector<double, 1>(next)}, step.arrow}, multipliers});
    time = next;
  }

  Newton newton(problem, std::move(path));
  TimedSolution<Sys> out;
  out.starts = start.starts;
  out.status = newton.solve(epsilon, max_iterations);
  // The secant method on epsilon, to where the slope is round-off or stops falling.
  double before = epsilon;
  double slope_before = newton.slope();
  epsilon *= 1 + 1e-4;
  for (int k = 0; k < 20 && out.status == SolveStatus::converged; ++k) {
    out.status = newton.solve(epsilon, max_iterations);
    const double slope = newton.slope();
    if (slope == 0 || (k > 0 && !(std::abs(slope) < 0.5 * std::abs(slope_before)))) break;
    before = std::exchange(epsilon, epsilon - slope * (epsilon - before) / (slope - slope_before));
    slope_before = slope;
  }
  if (!out.converged()) out.message = "no path with steps in proportion to the system's time scale was found";
  out.iterations = newton.iterations();
  out.residual = newton.residual();
  out.cost = newton.cost();
  out.energy = -newton.momentum_of_time();
  if (out.converged()) out.kind = newton.classify();
  detail::put_times<Sys>(newton.path(), start.times.front(), out);
  out.momenta = newton.momenta();
  return out;
}

}  // namespace lagroid
