#pragma once
/// Optimal control on a Lie groupoid G: arrows g_k with controls u_k in R^c, k = 1 ... N, whose product is given,
///
///     minimise  sum_k l(g_k, u_k, h),    phi(g_k, u_k, h) = 0,    gamma(g_k, u_k, h) <= 0,    lower <= u_k <= upper,
///
/// and where the last node is free in part, perhaps with a cost of it, Psi, beside the sum (ControlTask::end_cost).
///
/// A problem is a class that writes l, phi and gamma as they stand in a paper; its derivatives, exact second ones
/// included, are automatic. The step h = T / N may be an unknown: then T is free.
///
///     struct Dubins : ControlSystem<Dubins, SE2, /*controls*/ 1, /*equalities*/ 3> {
///       template <class S> S cost(const Arrow<S>&, const Controls<S>&, const S& h) const { return h; }
///       template <class S> Vector<S, 3> constraint(const Arrow<S>& g, const Controls<S>& u, const S& h) const {
///         return SE2::log(g) - Vector<S, 3>(h * u(0), h, S(0.0));  // turn, ahead, aside
///       }
///     };
///
/// Requires const templates on the scalar; phi determines the arrow from its source, its control and h where controls
/// are to steer it (as many equations as the dimension of G). Members that are missing do not compile. Solve with
/// `solve_control` (solve_control.hpp).
///
/// [G] section 5 for the equality-constrained case; Ober-Bloebaum, Junge, Marsden, ESAIM COCV 17 (2011), for discrete
/// mechanics and optimal control.

#include <lagroid/core/groupoid.hpp>
#include <lagroid/solvers/control/node_condition.hpp>
#include <lagroid/solvers/control/stage_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace lagroid {

/// Where the derivatives of a stage go, along x = (a, b, du, t) (transcription.hpp): of the cost, of each equality row
/// by row, and the Hessian of l + <lambda, phi>.
struct StagePlaces {
  double* gradient;
  double* equality;
  double* hessian;
};

/// Base of optimal control problems. The derived class writes, as const templates on the scalar S,
///
///     S cost(const Arrow<S>& g, const Controls<S>& u, const S& h)                             l
///     Vector<S, Equalities> constraint(g, u, h)                                               phi
///     Vector<S, Inequalities> inequality(g, u, h)        if there are any                     gamma
///
/// and may write conditions that the last object is to satisfy, with `static constexpr int end_equalities`:
///
///     Vector<S, end_equalities> end_constraint(const Object<S>& q)
///
/// or that every object after the first is to satisfy, with `static constexpr int node_equalities`; of the last one,
/// where what they restrict is free:
///
///     Vector<S, node_equalities> node_constraint(const Object<S>& q)
///
/// Where its parameters ask for no inequality, it may say so, `bool has_inequalities() const`: then none is evaluated.
/// Where they depend on the arrow's end and the controls alone, `static constexpr bool inequalities_of_end = true`
/// makes their derivatives cheaper (end_inequalities.hpp). One that knows the derivatives of its stages, second ones of
/// l + <lambda, phi>, writes them (else they are automatic):
///
///     void stage_derivatives(g, u, h, const double* lambda, const StagePlaces& out)
///
/// A task in several phases, one after another, gives each its duration, bounds and parameters, and what is to hold
/// where it ends:
///
///     task.phases = {{.stages = 40, .duration_is_free = true, .end_condition = gate}, {.stages = 60}};
template <class Derived, class G, int ControlCount, int Equalities, int Inequalities = 0> struct ControlSystem {
  using GroupoidType = G;
  static constexpr int dimension = G::dimension;
  static constexpr int controls = ControlCount;
  static constexpr int equalities = Equalities;
  static constexpr int inequalities = Inequalities;
  static constexpr int end_equalities = 0;
  static constexpr int node_equalities = 0;
  template <class S> using Arrow = typename G::template Arrow<S>;
  template <class S> using Object = typename G::template Object<S>;
  template <class S> using Controls = Vector<S, ControlCount>;

  [[no_unique_address]] G groupoid;
};

/// What a motion costs in place of its system's own cost: the integral of sum_j w_j u_j^2 + w.
template <int ControlCount> struct ControlWeights {
  Vector<double, ControlCount> of_controls = Vector<double, ControlCount>::Ones();  ///< w_j, not negative
  double of_time = 0;                                                               ///< w, not negative
};

/// A system whose running cost, `running_cost(q, u)` of its own, may be given by weights:
///
///     task.system.weights = {{1, 4}, 0.5};  // u_1^2 + 4 u_2^2 + 1/2
template <class Derived, int ControlCount> struct WeighedCost {
  std::optional<ControlWeights<ControlCount>> weights = {};

  template <class Q, class S> S cost_rate(const Q& q, const Vector<S, ControlCount>& u) const {
    if (!weights) return static_cast<const Derived&>(*this).running_cost(q, u);
    S sum = S(weights->of_time);
    for (int i = 0; i < ControlCount; ++i) sum += u(i) * u(i) * weights->of_controls(i);
    return sum;
  }
};

/// So many stages, each of the same duration h.
struct PhaseSteps {
  long stages = 0;
  double step = 0;
};

/// The arrows and controls of N stages, phase by phase.
template <class Sys> struct ControlTrajectory {
  using A = ArrowOf<typename Sys::GroupoidType>;
  std::vector<A> arrows;
  std::vector<Vector<double, Sys::controls>> controls;
  std::vector<PhaseSteps> phases;
  /// From the first object of the task's boundary to the first node, where that is free; none: it begins there.
  std::optional<A> start = {};

  /// h of a stage.
  double step(long stage = 0) const {
    std::size_t p = 0;
    while (p + 1 < phases.size() && stage >= phases[p].stages) stage -= phases[p++].stages;
    return phases[p].step;
  }
  /// Of a node, after the first.
  double time(long node) const {
    double sum = 0;
    for (const PhaseSteps& each : phases) {
      sum += double(std::min(node, each.stages)) * each.step;
      node -= std::min(node, each.stages);
    }
    return sum;
  }
  double duration() const { return time(long(arrows.size())); }
};

/// How large the numbers are that a displacement of a trajectory changes (Transcription::sizes_of_displaced).
template <class Sys>
void sizes_along(const typename Sys::GroupoidType& groupoid, const ControlTrajectory<Sys>& path,
                 TrajectoryDisplacement& out) {
  set_all(out.nodes, 0);
  for (std::size_t k = 0; k < path.arrows.size(); ++k) {
    const auto scale = groupoid.coordinate_scale(path.arrows[k]);
    for (int i = 0; i < Sys::dimension; ++i) {
      double& source = out.nodes[long(k)][i];
      source = std::max(source, scale(i));
      out.nodes[long(k) + 1][i] = scale(i);
    }
    for (int i = 0; i < Sys::controls; ++i) out.controls[long(k)][i] = std::abs(path.controls[k](i));
  }
  std::fill(out.durations.begin(), out.durations.end(), 1.0);
}

/// What a system is of a stage, over a scalar.
template <class Sys, class S> struct StageFunctions {
  S cost;
  Vector<S, Sys::equalities> equality;
  Vector<S, Sys::inequalities> inequality;
};

/// A part of a trajectory with a duration, bounds and parameters of its own. The next begins at the node where it ends.
template <class Sys> struct ControlPhase {
  using G = typename Sys::GroupoidType;

  Sys system = {};  ///< its parameters hold in this phase: costs, obstacles
  long stages = 50;
  double duration = 1;  ///< the first guess of it where it is free
  bool duration_is_free = false;
  double shortest = 0;  ///< of its duration, where that is free
  double longest = HUGE_VAL;
  /// Of controls; where both are the same number, the control is fixed there.
  Vector<double, Sys::controls> lower = Vector<double, Sys::controls>::Constant(-HUGE_VAL);
  Vector<double, Sys::controls> upper = Vector<double, Sys::controls>::Constant(HUGE_VAL);
  bool inequalities_hold = true;                            ///< those of the system
  std::shared_ptr<const NodeCondition<G>> end_condition{};  ///< of its last node
  std::optional<ArrowOf<G>> guess{};  ///< from the first object of the boundary to about where it ends
};

/// u_control <= a phase's upper bound (sign 1) or >= its lower bound (sign -1).
template <class Sys> struct PhaseControlBound {
  int control;
  double sign;
  double of(const ControlPhase<Sys>& phase) const { return sign > 0 ? phase.upper(control) : phase.lower(control); }
  bool holds(const ControlPhase<Sys>& phase) const {
    return std::isfinite(of(phase)) && phase.lower(control) < phase.upper(control);
  }
};
/// log(T / longest) <= 0 (sign 1) or log(shortest / T) <= 0 of a phase whose duration is free, in its first stage.
template <class Sys> struct PhaseDurationBound {
  double sign;
  double of(const ControlPhase<Sys>& phase) const { return sign > 0 ? phase.longest : phase.shortest; }
  bool holds(const ControlPhase<Sys>& phase) const {
    return phase.duration_is_free && (sign > 0 ? std::isfinite(phase.longest) : phase.shortest > 0);
  }
  double value(const ControlPhase<Sys>& phase, double duration) const { return sign * std::log(duration / of(phase)); }
};

/// Those that hold in one phase at least: of each control the upper, then the lower.
template <class Sys>
std::vector<PhaseControlBound<Sys>> control_bounds_of(const std::vector<ControlPhase<Sys>>& phases) {
  std::vector<PhaseControlBound<Sys>> out;
  for (int i = 0; i < Sys::controls; ++i)
    for (const double sign : {1.0, -1.0}) {
      const PhaseControlBound<Sys> bound{i, sign};
      if (std::any_of(phases.begin(), phases.end(), [&](const auto& phase) { return bound.holds(phase); }))
        out.push_back(bound);
    }
  return out;
}
/// The same of durations: longest, then shortest.
template <class Sys>
std::vector<PhaseDurationBound<Sys>> duration_bounds_of(const std::vector<ControlPhase<Sys>>& phases) {
  std::vector<PhaseDurationBound<Sys>> out;
  for (const double sign : {1.0, -1.0}) {
    const PhaseDurationBound<Sys> bound{sign};
    if (std::any_of(phases.begin(), phases.end(), [&](const auto& phase) { return bound.holds(phase); }))
      out.push_back(bound);
  }
  return out;
}

/// What is to be solved: a system between two ends, in one phase or several.
template <class Sys> struct ControlTask {
  using G = typename Sys::GroupoidType;
  static constexpr double none = std::numeric_limits<double>::infinity();
  static constexpr Vector<double, Sys::controls> all(double x) { return Vector<double, Sys::controls>::Constant(x); }

  Sys system;
  ArrowOf<G> boundary;  ///< from the first object to the last: the product of all arrows
  double duration = 1;  ///< T; the first guess of it where it is free
  bool duration_is_free = false;
  /// Components of the first and the last displacement, in A_qG, along which that end may move.
  std::array<bool, std::size_t(Sys::dimension)> free_start{};
  std::array<bool, std::size_t(Sys::dimension)> free_end{};
  Vector<double, Sys::controls> lower = all(-none);
  Vector<double, Sys::controls> upper = all(none);
  /// What an end is to satisfy that is free in part (node_condition.hpp).
  std::shared_ptr<const NodeCondition<G>> start_condition{};
  std::shared_ptr<const NodeCondition<G>> end_condition{};
  /// Psi of the last node, one number, which is added to the cost (node_condition.hpp); of an end that is free in part.
  std::shared_ptr<const NodeCondition<G>> end_cost{};
  /// One after another, in place of the system, duration and bounds above; none: these, in one phase.
  std::vector<ControlPhase<Sys>> phases{};
};

/// The phases of a task; where it names none, one of so many stages.
template <class Sys> std::vector<ControlPhase<Sys>> phases_of(const ControlTask<Sys>& task, long stages) {
  if (!task.phases.empty()) return task.phases;
  return {{.system = task.system,
           .stages = stages,
           .duration = task.duration,
           .duration_is_free = task.duration_is_free,
           .lower = task.lower,
           .upper = task.upper}};
}

/// At rest, or in the middle of the bounds.
template <class Sys> Vector<double, Sys::controls> resting_control(const ControlPhase<Sys>& phase) {
  Vector<double, Sys::controls> control;
  for (int i = 0; i < Sys::controls; ++i) {
    const double lower = phase.lower(i);
    const double upper = phase.upper(i);
    control(i) = std::isfinite(lower) && std::isfinite(upper) ? 0.5 * (lower + upper)
                 : std::isfinite(lower)                       ? std::max(0.0, lower + 1)
                 : std::isfinite(upper)                       ? std::min(0.0, upper - 1)
                                                              : 0.0;
  }
  return control;
}

/// Arrows tau(q, v / N) after one another, v the retraction's inverse of the boundary arrow, with controls at rest or
/// in the middle of their bounds: a trajectory to start from. The last arrow is what remains. Where phases have guesses
/// of their ends, the same from one to the next. The phases' stages count where there are phases.
template <class Sys> ControlTrajectory<Sys> straight_trajectory(const ControlTask<Sys>& task, long stages = 0) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = task.system.groupoid;
  const std::vector<ControlPhase<Sys>> phases = phases_of(task, stages);
  ControlTrajectory<Sys> out;
  for (const ControlPhase<Sys>& each : phases) {
    out.phases.push_back({each.stages, each.duration / double(each.stages)});
    out.controls.insert(out.controls.end(), std::size_t(each.stages), resting_control(each));
  }
  ArrowOf<G> product = groupoid.unit(groupoid.source(task.boundary));
  for (std::size_t first = 0; first < phases.size();) {
    // Phases up to the next end that is known.
    std::size_t last = first;
    double duration = phases[first].duration;
    long count = phases[first].stages;
    while (last + 1 < phases.size() && !phases[last].guess) {
      ++last;
      duration += phases[last].duration;
      count += phases[last].stages;
    }
    const ArrowOf<G>& end = last + 1 < phases.size() ? *phases[last].guess : task.boundary;
    const ArrowOf<G> way = first == 0 ? end : groupoid.compose(groupoid.inverse(product), end);
    const AlgebroidVector<G> part = groupoid.tau_inverse(way) / double(count);
    for (; first <= last; ++first) {
      // How much longer its stages are than those of all these phases on average.
      const double length = phases[first].duration / double(phases[first].stages) / (duration / double(count));
      const long whole = phases[first].stages - (first == last ? 1 : 0);
      for (long k = 0; k < whole; ++k) {
        out.arrows.push_back(groupoid.tau(groupoid.target(product), AlgebroidVector<G>(length * part)));
        product = groupoid.compose(product, out.arrows.back());
      }
    }
    out.arrows.push_back(groupoid.compose(groupoid.inverse(product), end));
    product = end;
  }
  return out;
}

}  // namespace lagroid
