#pragma once
/// Paths whose arrows say when they begin and end.

#include <lagroid/groupoids/time_extended.hpp>
#include <lagroid/solvers/boundary/boundary_problem.hpp>

#include <tuple>
#include <vector>

namespace lagroid {

/// A path with the times of its nodes, one more than there are arrows. Multipliers are those of the system itself.
template <DiscreteSystem Sys> struct TimedPath {
  Path<Sys> path;
  std::vector<double> times;
};

/// A stationary path with its times, or the best iterate of a solve that failed.
template <DiscreteSystem Sys> struct TimedSolution : BoundaryOutcome, TimedPath<Sys> {
  double energy = 0;                     ///< E_d on the first arrow, where the times were solved for
  double energy_defect = 0;              ///< the largest difference in the equation of energy at a node
  std::vector<double> step_multipliers;  ///< of t1 - t0 = h(g), one an arrow, where steps are prescribed
  /// Of the nodes, where steps are prescribed: their constraint has a part in them.
  std::vector<AlgebroidVector<typename Sys::GroupoidType>> momenta;
};

/// Equal steps from `start` on.
inline std::vector<double> equal_times(double start, double h, std::size_t steps) {
  std::vector<double> times(steps + 1);
  for (std::size_t k = 0; k <= steps; ++k) times[k] = start + h * double(k);
  return times;
}

/// The system that boundary values of equal steps are solved for: the system itself, or, where it depends on time, the
/// one whose arrows carry their times.
template <DiscreteSystem Sys> struct EqualStepsOf { using Type = Sys; };
template <DiscreteSystem Sys>
requires TimeDependent<Sys>
struct EqualStepsOf<Sys> {
  using Type = FixedStep<Sys>;
};
template <DiscreteSystem Sys> using EqualSteps = typename EqualStepsOf<Sys>::Type;

/// The boundary value of `boundary` in so many equal steps, from the system's own time on where it depends on time.
template <DiscreteSystem Sys>
BoundaryStage<EqualSteps<Sys>> equal_steps_stage(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& boundary,
                                                 std::size_t steps) {
  if constexpr (TimeDependent<Sys>) {
    return {
        {FixedStep<Sys>(system, ConstantStep{system.h}), timed_boundary<Sys>(boundary, system.time, system.h, steps)},
        steps};
  } else {
    return {{system, boundary}, steps};
  }
}

/// What was made of the system and of its boundary arrow, as they were.
template <DiscreteSystem Sys> const Sys& untimed(const EqualSteps<Sys>& system) {
  if constexpr (TimeDependent<Sys>) {
    return system.base;
  } else {
    return system;
  }
}
template <DiscreteSystem Sys>
const ArrowOf<typename Sys::GroupoidType>& untimed_boundary(const BoundaryProblem<EqualSteps<Sys>>& problem) {
  if constexpr (TimeDependent<Sys>) {
    return std::get<1>(problem.boundary);
  } else {
    return problem.boundary;
  }
}

namespace detail {

/// A time-extended path as one of the system and its times, which count from `origin`. `Extended` has the multipliers
/// of the system and, of steps that are prescribed, one more between those of arrows and of objects.
template <Timed Sys, DiscreteSystem Extended>
void put_times(const Path<Extended>& path, double origin, TimedSolution<Sys>& out) {
  constexpr int phis = Sys::arrow_constraints;
  out.path.clear();
  out.times.clear();
  out.step_multipliers.clear();
  for (const auto& [extended, lambda] : path) {
    const auto& [time, arrow] = extended;
    if (out.times.empty()) out.times.push_back(origin + time.source(0));
    out.times.push_back(origin + time.target(0));
    typename Sys::Multipliers own;
    own.template head<phis>() = lambda.template head<phis>();
    own.template tail<Sys::object_constraints>() = lambda.template tail<Sys::object_constraints>();
    out.path.push_back({arrow, own});
    if constexpr (Extended::arrow_constraints > phis) out.step_multipliers.push_back(lambda(phis));
  }
}

}  // namespace detail

/// The solution of `stage`, a boundary value of equal steps, with its times.
template <DiscreteSystem Sys>
TimedSolution<Sys> with_times(const BoundaryStage<EqualSteps<Sys>>& stage,
                              const BoundarySolution<EqualSteps<Sys>>& solution) {
  TimedSolution<Sys> out;
  static_cast<BoundaryOutcome&>(out) = solution;
  const auto& system = stage.problem.system;
  if constexpr (TimeDependent<Sys>) {
    detail::put_times<Sys>(solution.path, system.origin, out);
    // Of a constant step they say nothing; and as the last step follows from the others, neither does their rank.
    out.step_multipliers.clear();
    out.kind.normal = true;
  } else {
    out.path = solution.path;
    out.times = equal_times(0, time_step(system), solution.path.size());
  }
  return out;
}

}  // namespace lagroid
