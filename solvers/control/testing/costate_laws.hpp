#pragma once
/// Between changes of the active set an extremal is a motion of a discrete Hamiltonian system: what a stage leads to is
/// what it begins with, with the costate, by a symplectic map (the discrete maximum principle). So for extremals that
/// begin and end a little beside each other
///
///     Omega_k(delta_1, delta_2) is the same at every node k,
///
/// delta the displacement of the node and the change of its costate, which is
///
///     p_k = d/db (l + <lambda, phi> + <z, gamma>)(g_k, u_k),    b the displacement of the arrow's target.
///
///     const laws::LawReport report = laws::costate_laws(task, solve_control(task, 50));
///     std::cout << report;
///
/// One is varied by its start, the other by its end: differences of solutions that the solver finds from there. Where
/// inequalities are active that were not, or the other way round, nothing is said. Requires a solution that converged,
/// of one phase in a given time between given ends, without conditions on nodes. Returns a LawReport; nothing throws.

#include <lagroid/core/testing/symplectic_form.hpp>
#include <lagroid/solvers/control/solve_control.hpp>
#include <lagroid/solvers/control/testing/control_solution_laws.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

namespace lagroid::laws {

/// What finds extremals. Another in its place shows that the law fails.
struct FoundExtremals {
  template <class Sys>
  ControlSolution<Sys> operator()(const ControlTask<Sys>& task, ControlTrajectory<Sys> from) const {
    return solve_control(task, std::move(from), {.first_barrier = 1e-6});
  }
};

namespace detail {

/// The costates of nodes 1 ... N.
template <class Sys>
std::vector<AlgebroidVector<typename Sys::GroupoidType>> costates_of(const ControlTask<Sys>& task,
                                                                     const ControlSolution<Sys>& solution) {
  constexpr int n = Sys::dimension;
  const TranscriptionOf<Sys> transcription(task, solution.trajectory);
  const TranscriptionSizes& sizes = transcription.sizes();
  const int width = sizes.variables();
  StageDerivatives at(sizes);
  transcription.derivatives(stage_rows(solution.costates, sizes.equality),
                            stage_rows(solution.inequality_multipliers, sizes.inequality), at);
  std::vector<AlgebroidVector<typename Sys::GroupoidType>> out;
  for (long k = 0; k < sizes.stages; ++k) {
    Vector<double, n> costate;
    for (int i = 0; i < n; ++i) {
      costate(i) = at.gradient[k][n + i];
      for (int row = 0; row < sizes.equality; ++row)
        costate(i) += solution.costates[std::size_t(k)][std::size_t(row)] * at.equality[k][row * width + n + i];
      for (int row = 0; row < sizes.general_inequality(); ++row)
        costate(i) +=
            solution.inequality_multipliers[std::size_t(k)][std::size_t(row)] * at.inequality[k][row * width + n + i];
    }
    out.push_back(costate);
  }
  return out;
}

template <class Sys> std::vector<bool> active_in(const ControlSolution<Sys>& solution) {
  std::vector<bool> out;
  for (const std::vector<double>& stage : solution.inequality_multipliers)
    for (const double z : stage) out.push_back(z > 1e-7);
  return out;
}

}  // namespace detail

template <class Sys, class Find = FoundExtremals>
LawReport costate_laws(const ControlTask<Sys>& task, const ControlSolution<Sys>& solution, const Find& find = {},
                       std::uint64_t seed = 1, double tolerance = 1e-5) {
  using G = typename Sys::GroupoidType;
  using V = AlgebroidVector<G>;
  constexpr int n = Sys::dimension;
  constexpr double width = 1e-4;
  const G& groupoid = task.system.groupoid;
  const long stages = long(solution.trajectory.arrows.size());
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&] {
    V out;
    for (int i = 0; i < n; ++i) out(i) = uniform(generator);
    return out;
  };
  /// The extremal between ends that are displaced, with the arrow from the start to each of its nodes.
  struct Beside {
    std::vector<ArrowOf<G>> reached;
    std::vector<V> costates;
    std::vector<bool> active;
  };
  const auto beside = [&](const V& at_start, const V& at_end) -> std::optional<Beside> {
    ControlTask<Sys> moved = task;
    ControlTrajectory<Sys> from = solution.trajectory;
    const ArrowOf<G> begin = groupoid.tau(groupoid.source(task.boundary), at_start);
    const ArrowOf<G> end = groupoid.tau(groupoid.target(task.boundary), at_end);
    moved.boundary = groupoid.multiply(groupoid.multiply(groupoid.inverse(begin), task.boundary), end);
    from.arrows.front() = groupoid.multiply(groupoid.inverse(begin), from.arrows.front());
    from.arrows.back() = groupoid.multiply(from.arrows.back(), end);
    const ControlSolution<Sys> found = find(moved, std::move(from));
    if (!found.report.converged()) return std::nullopt;
    Beside out{{begin}, detail::costates_of(moved, found), detail::active_in(found)};
    for (const ArrowOf<G>& each : found.trajectory.arrows)
      out.reached.push_back(groupoid.multiply(out.reached.back(), each));
    return out;
  };

  LawReport report{"costates", {}};
  Law law = detail::control_law("Omega of two variations is the same at every node", 0, tolerance, 0);
  const V none = V::Zero(), along_start = draw(), along_end = draw();
  const auto pair = [&](const V& start, const V& end) {
    return std::pair(beside(width * start, width * end), beside(-width * start, -width * end));
  };
  const auto [first_above, first_below] = pair(along_start, none);
  const auto [second_above, second_below] = pair(none, along_end);
  const auto here = beside(none, none);
  const std::vector<bool> active = detail::active_in(solution);
  const auto stays = [&](const std::optional<Beside>& each) { return each && each->active == active; };
  const auto all = {&here, &first_above, &first_below, &second_above, &second_below};
  if (!std::all_of(all.begin(), all.end(), [&](const auto* each) { return stays(*each); })) {
    const bool converged = std::all_of(all.begin(), all.end(), [](const auto* each) { return each->has_value(); });
    law.skipped = 1;
    law.skipped_because =
        converged ? "the active set changes beside the extremal" : "no extremal is found beside this one";
    law.unjudged = true;
    report.laws.push_back(law);
    return report;
  }
  const auto variation = [&](const Beside& above, const Beside& below, long node) {
    const auto displaced = [&](const Beside& each) {
      return V(groupoid.tau_inverse(
          groupoid.multiply(groupoid.inverse(here->reached[std::size_t(node)]), each.reached[std::size_t(node)])));
    };
    Eigen::VectorXd out(2 * n);
    out << displaced(above) - displaced(below),
        above.costates[std::size_t(node - 1)] - below.costates[std::size_t(node - 1)];
    return Eigen::VectorXd(out / (2 * width));
  };
  std::vector<double> forms;
  double terms = 0;
  for (long node = 1; node < stages; ++node) {
    const Eigen::VectorXd first = variation(*first_above, *first_below, node);
    const Eigen::VectorXd second = variation(*second_above, *second_below, node);
    const State<G> state{groupoid.target(here->reached[std::size_t(node)]), here->costates[std::size_t(node - 1)]};
    forms.push_back(first.dot(detail::symplectic_form(groupoid, state) * second));
    terms = std::max(terms, first.norm() * second.norm());
  }
  law.samples = int(forms.size());
  for (const double form : forms) law.worst = worst({law.worst, std::abs(form - forms.front()) / terms});
  // A form that is itself of the size of the tolerance would hold whatever it does.
  if (forms.empty() || !(std::abs(forms.front()) > 100 * tolerance * terms))
    law.first_failure = "the form of these variations vanishes: another seed draws others";
  report.laws.push_back(law);
  return report;
}

}  // namespace lagroid::laws
