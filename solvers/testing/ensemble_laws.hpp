#pragma once
/// The laws of an ensemble: a member is its own trajectory, whatever the others are, their order, the threads and the
/// pauses; and it fails alone.
///
///     const auto draw = [] { return State<Pair<2>>{{1, 0}, {0, 1 + 0.1 * laws::draw_uniform()}}; };
///     std::cout << laws::ensemble_laws(Kepler{}, draw);
///
/// Requires a system that can be evaluated on batches.

#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/ensemble/ensemble.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::laws {

namespace detail {

/// The coordinates of all that a member has reached.
template <DiscreteSystem Sys> Eigen::VectorXd numbers_of_point(const Sys& system, const TrajectoryPoint<Sys>& point) {
  const auto object = system.groupoid.coordinates_of_object(point.state.object);
  const auto configuration = system.groupoid.coordinates_of_arrow(point.configuration);
  const auto arrow = system.groupoid.coordinates_of_arrow(point.step.arrow);
  Eigen::VectorXd out(object.size() + point.state.momentum.size() + configuration.size() + arrow.size() +
                      point.step.multipliers.size() + 1);
  out << object, point.state.momentum, configuration, arrow, point.step.multipliers, double(point.index);
  return out;
}

/// How many members of two ensembles differ in a bit or in their outcome; member i of one is member order[i] of the
/// other.
template <class One, class Other>
double different(const One& one, const Other& other, const std::vector<std::size_t>& order) {
  double count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto a = numbers_of_point(one.system(), one.point(long(i)));
    const auto b = numbers_of_point(other.system(), other.point(long(order[i])));
    count += one.status(long(i)) != other.status(long(order[i])) || a != b;
  }
  return count;
}

}  // namespace detail

/// For ensembles of `members` random initial states, which `draw()` returns, over `steps` steps:
///
/// - "a member is its own trajectory": state and configuration are those of a `FixedStepIntegrator` by `NewtonStep`,
///   to `tolerance` relative to their size (or to one, if that is more), and a `FixedStepIntegrator` fails where the
///   member does;
/// - "members do not know their order": in another order they are the same, to the bit;
/// - "a member fails alone": where every third member starts from an infinite momentum, these fail at their first step,
///   and the others are what they were, to the bit;
/// - "threads and pauses change nothing": three threads, or steps in several advances, leave the same bits.
template <class Members, DiscreteSystem Sys, class Draw>
LawReport ensemble_laws_of(const Sys& system, const Draw& draw, int members, int steps, double tolerance) {
  using G = typename Sys::GroupoidType;
  LawReport report{"ensemble", {}};
  const auto drawn = [&] {
    std::vector<State<G>> initial;
    for (int i = 0; i < members; ++i) initial.push_back(draw());
    return initial;
  };
  const auto advanced = [&](const std::vector<State<G>>& initial, int threads = 1) {
    Members ensemble(system, initial);
    typename Members::Options options;
    options.threads = threads;
    ensemble.advance_to(steps, options);
    return ensemble;
  };
  std::vector<std::size_t> same(std::size_t(members), 0);
  for (std::size_t i = 0; i < same.size(); ++i) same[i] = i;

  report.laws.push_back(check_law("a member is its own trajectory", tolerance, [&] {
    const auto initial = drawn();
    const auto ensemble = advanced(initial);
    double largest = 0;
    for (std::size_t i = 0; i < initial.size(); ++i) {
      FixedStepIntegrator<Sys> alone(system, initial[i], system.groupoid.unit(initial[i].object),
                                     std::make_unique<NewtonStep<Sys>>());
      auto status = SolveStatus::converged;
      for (int k = 0; k < steps && status == SolveStatus::converged; ++k) status = alone.advance().status;
      const auto point = ensemble.point(long(i));
      if (point.index != alone.point().index) return 1.0;
      const auto a = system.groupoid.coordinates_of_arrow(point.configuration);
      const auto b = system.groupoid.coordinates_of_arrow(alone.point().configuration);
      const auto& mu = alone.point().state.momentum;
      largest = worst({largest, (a - b).norm() / std::max(1.0, b.norm()),
                       (point.state.momentum - mu).norm() / std::max(1.0, mu.norm())});
    }
    return largest;
  }));
  report.laws.push_back(check_law("members do not know their order", 0, [&] {
    const auto initial = drawn();
    std::vector<std::size_t> order = same;
    std::rotate(order.begin(), order.begin() + members / 3, order.end());
    std::swap(order.front(), order[order.size() / 2]);
    std::vector<State<G>> others(initial.size());
    for (std::size_t i = 0; i < initial.size(); ++i) others[order[i]] = initial[i];
    return detail::different(advanced(initial), advanced(others), order);
  }));
  report.laws.push_back(check_law("a member fails alone", 0, [&] {
    auto initial = drawn();
    const auto healthy = advanced(initial);
    std::vector<std::size_t> rest;
    for (std::size_t i = 0; i < initial.size(); ++i) {
      if (i % 3 == 1) {
        initial[i].momentum.setConstant(std::numeric_limits<double>::infinity());
      } else {
        rest.push_back(i);
      }
    }
    const auto ensemble = advanced(initial);
    double count = 0;
    for (std::size_t i = 1; i < initial.size(); i += 3)
      count += ensemble.status(long(i)) == SolveStatus::converged || ensemble.point(long(i)).index != 0;
    for (const std::size_t i : rest)
      count += ensemble.status(long(i)) != healthy.status(long(i)) ||
               detail::numbers_of_point(system, ensemble.point(long(i))) !=
                   detail::numbers_of_point(system, healthy.point(long(i)));
    return count;
  }));
  report.laws.push_back(check_law("threads and pauses change nothing", 0, [&] {
    const auto initial = drawn();
    const auto once = advanced(initial);
    Members paused(system, initial);
    for (int index = 0; index < steps; index += 7) paused.advance_to(index);
    paused.advance_to(steps);
    return detail::different(once, advanced(initial, 3), same) + detail::different(once, paused, same);
  }));
  return report;
}

/// The laws of `Ensemble` for a system, on batches of `Width` lanes. States near one another and far apart are worth
/// drawing; a system that can not be evaluated on batches does not compile.
template <int Width = widest_batch, DiscreteSystem Sys, class Draw>
LawReport ensemble_laws(const Sys& system, const Draw& draw, int members = 19, int steps = 40,
                        double tolerance = 1e-11) {
  return ensemble_laws_of<Ensemble<Sys, Width>>(system, draw, members, steps, tolerance);
}

}  // namespace lagroid::laws
