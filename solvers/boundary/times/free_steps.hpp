#pragma once
/// Boundary values whose step sizes are part of the path. [G] Example 6.1

#include <lagroid/groupoids/time_extended.hpp>
#include <lagroid/solvers/boundary/boundary_kkt.hpp>
#include <lagroid/solvers/boundary/times/timed_path.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

struct FreeStepsOptions {
  int max_iterations = 40;
  double largest_change = 2;        ///< of the step size, from one step to the next; above 1
  double largest_displacement = 1;  ///< bound on a node displacement in one iteration, in coordinates of AG
};

namespace detail {

/// The time-extended system whose steps stay as they are: a constraint of value zero, with the derivative of t1 - t0.
template <Timed Base> struct HeldSteps : OnTimeExtended<HeldSteps<Base>, Base, 1> {
  explicit HeldSteps(const FreeTime<Base>& free) : OnTimeExtended<HeldSteps, Base, 1>(free.base) {
    this->origin = free.origin;
  }

  template <class S, class A> auto constraint(const std::tuple<PairArrow<S, 1>, A>& g) const {
    Vector<S, Base::arrow_constraints + 1> c;
    if constexpr (Base::arrow_constraints > 0) c.template head<Base::arrow_constraints>() = this->base_constraint(g);
    const S step = this->step(std::get<0>(g));
    c(Base::arrow_constraints) = step - value_of(step);
    return c;
  }
};

/// Newton's method on the equations of motion and of energy together.
///
/// A time node that is displaced along the motion leaves the action of continuous time as it was. What decides on the
/// step sizes is the error of the discretisation, - sum_k h_k^3 a(z_k) / 3 to leading order. So in these directions the
/// matrix is smaller by h^2, and the paths that are motions at their times lie in a narrow, curved valley, off which a
/// displacement of finite size leads. Hence each step of Newton's method on all equations, shortened where a step size
/// would change by more than a factor of two, is followed by steps that find the motion at the new times; that is
/// Newton's method on the action as a function of the times alone. The residual of the energy says little of how far
/// off the steps are: the iteration goes on until round-off ends it.
template <Timed Sys> class FreeStepsNewton {
 public:
  using Extended = FreeTime<Sys>;
  using Held = HeldSteps<Sys>;
  static constexpr int n = Extended::dimension;
  static constexpr int m = Extended::constraints;

  FreeStepsNewton(const BoundaryProblem<Extended>& problem, Path<Extended> path, const FreeStepsOptions& options)
      : problem_(problem), held_{Held(problem.system), problem.boundary}, options_(options), path_(std::move(path)) {}

  /// Runs the iteration; `converged` where it ended at round-off.
  SolveStatus solve() {
    evaluate();
    double best = std::numeric_limits<double>::infinity();
    Path<Extended> kept = path_;
    SolveStatus status = SolveStatus::not_converged;
    int without_gain = 0;
    for (; iterations_ < options_.max_iterations && without_gain < 3; ++iterations_) {
      if (!std::isfinite(residual_)) {
        status = SolveStatus::not_finite;
        break;
      }
      const double merit = std::max(residual_ / residual_tolerance, defect_ / energy_roundoff());
      without_gain = merit < 0.5 * best ? 0 : without_gain + (best < 1 ? 1 : 0);
      if (merit < best) {
        best = merit;
        kept = path_;
      }
      if (!advance()) break;
    }
    path_ = std::move(kept);
    evaluate();
    return best <= 1 ? SolveStatus::converged : status;
  }

  const Path<Extended>& path() const { return path_; }
  int iterations() const { return iterations_; }
  double residual() const { return residual_; }
  double defect() const { return defect_; }

  /// Directions that lower the action, those of time among them.
  long negative_directions() {
    evaluate();
    return kkt_.factor(0, 0).negative - kkt_.constraint_count();
  }
  /// How much E_d of an arrow changes with its step size, relative to E_d's own round-off: the response to forces of
  /// alternating sign on the times. On entry as `negative_directions` leaves it.
  double energy_sensitivity() const {
    Columns force(path_.size(), Columns::value_type::Zero());
    for (std::size_t k = 0; k + 1 < force.size(); ++k) force[k](m) = (k % 2 == 0 ? 1 : -1) * kkt_.scale()(m);
    kkt_.solve_in_place(force);
    Variation<Extended> response;
    kkt_.unscale(force, response);
    double moved = 0;
    for (const auto& v : response.nodes) moved += v(0) * v(0);
    moved = std::sqrt(moved / double(path_.size()));
    return step(problem_.boundary) / double(path_.size()) / (moved * energy_roundoff());
  }
  double largest_ratio() const {
    double ratio = 1;
    for (std::size_t k = 1; k < path_.size(); ++k) {
      const double change = step(path_[k].arrow) / step(path_[k - 1].arrow);
      ratio = std::max({ratio, change, 1 / change});
    }
    return ratio;
  }

 private:
  using Columns = typename BoundaryKkt<Extended>::Columns;
  static constexpr double residual_tolerance = 1e-10;
  /// Of the held steps the last follows from the others, so that their multipliers are determined up to a constant.
  static constexpr double redundancy_shift = 1e-10;

  static double step(const ArrowOf<typename Extended::GroupoidType>& g) { return Extended::step(std::get<0>(g)); }

  void evaluate() {
    kkt_.evaluate(problem_.system, path_);
    kkt_.choose_scale();
    residual_ = kkt_.residual_norm();
    defect_ = 0;
    for (std::size_t k = 0; k + 1 < path_.size(); ++k) defect_ = std::max(defect_, std::abs(kkt_.residual()[k](m)));
  }

  /// False where there is no motion at the new times, however near to the old.
  bool advance() {
    kkt_.newton_side(side_);
    kkt_.factor(0, 0);
    kkt_.solve_in_place(side_);
    kkt_.unscale(side_, variation_);
    double fraction = 1;
    double before = 0;
    for (std::size_t k = 0; k < path_.size(); ++k) {
      const auto& v = variation_.nodes[k];
      const double change = (v(0) - before) / step(path_[k].arrow);
      before = v(0);
      fraction = std::min({fraction, 0.5 / std::max(-change, 1e-300), 1 / std::max(change, 1e-300),
                           options_.largest_displacement / std::max(v.template tail<n - 1>().norm(), 1e-300)});
    }
    for (int halving = 0; halving < 8; ++halving, fraction /= 2) {
      displace(problem_, path_, variation_, fraction, trial_);
      if (find_motion(trial_)) {
        std::swap(path_, trial_);
        evaluate();
        return true;
      }
    }
    return false;
  }

  /// Newton's method at the times of the path: until round-off ends it, or false.
  bool find_motion(Path<Extended>& path) {
    constexpr int phis = Sys::arrow_constraints;
    constexpr int objects = Sys::object_constraints;
    Path<Held> held(path.size());
    for (std::size_t k = 0; k < path.size(); ++k) {
      held[k].arrow = path[k].arrow;
      held[k].multipliers.template head<phis>() = path[k].multipliers.template head<phis>();
      held[k].multipliers(phis) = 0;
      held[k].multipliers.template tail<objects>() = path[k].multipliers.template tail<objects>();
    }
    double last = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < 12; ++iteration) {
      held_kkt_.evaluate(held_.system, held);
      held_kkt_.choose_scale();
      if (!std::isfinite(held_kkt_.residual_norm())) return false;
      held_kkt_.newton_side(held_side_);
      held_kkt_.factor(0, redundancy_shift);
      held_kkt_.solve_in_place(held_side_);
      held_kkt_.unscale(held_side_, held_variation_);
      double reach = 0;
      for (const auto& v : held_variation_.nodes) reach = std::max(reach, v.norm());
      if (!(reach < options_.largest_displacement)) return false;
      displace(held_, held, held_variation_, 1.0, held_trial_);
      std::swap(held, held_trial_);
      const bool at_roundoff = reach < 1e-14 || (reach < 1e-9 && !(reach < 0.25 * last));
      last = reach;
      if (at_roundoff) break;
    }
    if (!(last < 1e-9)) return false;
    for (std::size_t k = 0; k < path.size(); ++k) {
      path[k].arrow = held[k].arrow;
      path[k].multipliers.template head<phis>() = held[k].multipliers.template head<phis>();
      path[k].multipliers.template tail<objects>() = held[k].multipliers.template tail<objects>();
      if (!problem_.system.admissible(path[k].arrow)) return false;
    }
    return true;
  }

  /// What round-off leaves of the energy equation: E_d divides the arrow's coordinates, which are stored to so many
  /// digits, by the step.
  double energy_roundoff() const {
    double size = 0;
    const auto& groupoid = problem_.system.base.groupoid;
    for (const auto& s : path_) {
      const auto momentum = legendre_plus(problem_.system, s).momentum;
      const double along =
          momentum.template tail<n - 1>().cwiseAbs().dot(groupoid.coordinate_scale(std::get<1>(s.arrow)));
      size = std::max(size, std::abs(momentum(0)) + along / step(s.arrow));
    }
    return 64 * std::numeric_limits<double>::epsilon() * size;
  }

  const BoundaryProblem<Extended>& problem_;
  BoundaryProblem<Held> held_;
  FreeStepsOptions options_;
  Path<Extended> path_;
  Path<Extended> trial_;
  BoundaryKkt<Extended> kkt_;
  Columns side_;
  Variation<Extended> variation_;
  BoundaryKkt<Held> held_kkt_;
  typename BoundaryKkt<Held>::Columns held_side_;
  Variation<Held> held_variation_;
  Path<Held> held_trial_;
  double residual_ = 0;
  double defect_ = 0;
  int iterations_ = 0;
};

}  // namespace detail

/// The path with its times as one of the time-extended groupoid, whose times count from the first.
template <Timed Sys> Path<FreeTime<Sys>> extended_path(const TimedPath<Sys>& timed) {
  Path<FreeTime<Sys>> out;
  const auto time = [&](std::size_t k) { return Vector<double, 1>(timed.times[k] - timed.times[0]); };
  for (std::size_t k = 0; k < timed.path.size(); ++k) {
    const auto& [arrow, multipliers] = timed.path[k];
    out.push_back({{PairArrow<double, 1>{time(k), time(k + 1)}, arrow}, multipliers});
  }
  return out;
}

/// Of all paths that make up the arrow `boundary` in the time of `start`, one whose motion and whose step sizes make
/// the action stationary together: a boundary value on R x R x G. `start` is a solution with other steps, equal ones
/// for instance.
///
/// The equation of the times is that of the discrete energy, corrected as `FreeTime` says, so that E_d is the same on
/// all arrows where the system does not depend on time. It has no root in general: E_d = H + a(z) h^2 + ..., and where
/// a(z) changes sign along the path no positive steps keep it (`no_step`); where E_d does not depend on h, any steps do
/// (`degenerate`). Neither is a fault of the solver; `not_converged` is.
///
/// The solution's kind is that of its motion at the times found. By the times the action is stationary too: the least
/// value where a(z) < 0, the greatest where a(z) > 0. Minus E_d is its derivative by the end time.
template <Timed Sys>
TimedSolution<Sys> solve_free_steps(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& boundary,
                                    const TimedSolution<Sys>& start, const FreeStepsOptions& options = {}) {
  BoundaryProblem<FreeTime<Sys>> problem{FreeTime<Sys>(system),
                                         timed_boundary<Sys>(boundary, 0, start.times.back() - start.times.front(), 1)};
  problem.system.origin = start.times.front();
  detail::FreeStepsNewton<Sys> newton(problem, extended_path<Sys>(start), options);
  const long times = long(start.path.size()) - 1;
  TimedSolution<Sys> out;
  out.kind = start.kind;
  out.starts = start.starts;
  // Of the directions of time, those that lower the action: none or all, where a(z) keeps its sign.
  const long lowered = newton.negative_directions() - start.kind.negative_directions;
  if (!(newton.energy_sensitivity() >= 1)) {
    out.status = SolveStatus::degenerate;
    out.message =
        "the discrete energy does not depend on the step: every sequence of steps is stationary, to round-off";
  } else {
    out.status = newton.solve();
    const bool found = out.converged() && newton.largest_ratio() <= options.largest_change;
    if (!found && lowered > 0 && lowered < times) {
      out.status = SolveStatus::no_step;
      out.message =
          "no steps keep the discrete energy: the error of the discretisation changes its sign along the path";
    } else if (!found && out.converged()) {
      out.status = SolveStatus::no_step;
      out.message = "no steps keep the discrete energy that change gradually along the path";
    }
  }
  out.iterations = newton.iterations();
  if (out.converged()) {
    const long negative = newton.negative_directions();
    out.kind.negative_directions = negative >= times ? negative - times : negative;
    out.kind.is_minimum = out.kind.negative_directions == 0;
  }
  out.residual = newton.residual();
  out.energy_defect = newton.defect();
  out.cost = action(problem.system, newton.path());
  out.energy = -legendre_minus(problem.system, newton.path().front()).momentum(0);
  detail::put_times<Sys>(newton.path(), start.times.front(), out);
  return out;
}

}  // namespace lagroid
