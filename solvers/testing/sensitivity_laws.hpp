#pragma once
/// What holds of exact derivatives of a run, as laws of any system: its transition matrix A is symplectic,
///
///     A^T Omega_N A = Omega_0,    Omega = [-B -I; I 0],  B_ij = <mu, [e_i, e_j]>,
///
/// gradients taken backwards are those taken forwards, the momentum of a symmetry keeps its gradient, and all of them
/// are what differences of the program itself tend to.
///
///     const auto draw = [] { return State<Pair<2>>{{1, 0}, {0, 1 + 0.1 * laws::draw_uniform()}}; };
///     std::cout << laws::sensitivity_laws(Kepler{}, draw);
///
/// A wrong Hessian that is symmetric still makes a symplectic matrix: the differences alone see it. Requires a system
/// whose declared parameters are all read by `varied`, and states from which steps can be taken; one from which a step
/// fails is passed over. Of a system that is not variational the first law is left out, of one without symmetries or
/// with nonholonomic constraints the third.

#include <lagroid/core/algebroid.hpp>
#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/derivatives/extrapolated_difference.hpp>
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/core/testing/property.hpp>
#include <lagroid/core/testing/symplectic_form.hpp>
#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::laws {

namespace detail {

/// The directions along which a state may move: displacements that keep the object constraints, and all momenta.
template <DiscreteSystem Sys>
Eigen::MatrixXd tangent_directions(const Sys& system, const State<typename Sys::GroupoidType>& state) {
  constexpr int n = Sys::dimension;
  constexpr int objects = Sys::object_constraints;
  if constexpr (objects == 0) {
    return Eigen::MatrixXd::Identity(2 * n, 2 * n);
  } else {
    const auto d = two_sided(system, system.groupoid.unit(state.object), Sys::Multipliers::Zero().eval());
    const Eigen::MatrixXd normal = d.constraint_source.template rightCols<objects>();
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(2 * n, 2 * n - objects);
    out.topLeftCorner(n, n - objects) = orthogonal_factor(normal).rightCols(n - objects);
    out.bottomRightCorner(n, n).setIdentity();
    return out;
  }
}

/// The end of a run by equal steps, with the momentum that is reported. Throws NotSampled where a step fails.
template <DiscreteSystem Sys>
TrajectoryPoint<Sys> end_of_run(const Sys& system, const State<typename Sys::GroupoidType>& start, long steps) {
  auto integrator = newton_integrator(system, start);
  for (long k = 0; k < steps; ++k)
    if (const auto report = integrator.advance(); !report.converged()) throw no_step(report);
  auto point = integrator.point();
  point.state.momentum = tangent_momentum(system, point.state);
  return point;
}

/// f'(0), by central differences of so many widths, each half of the one before, extrapolated.
inline Eigen::VectorXd extrapolated_difference(const std::function<Eigen::VectorXd(double)>& f, double width,
                                               int widths = 3) {
  return lagroid::extrapolated_difference(f, width, widths)->value;
}

/// (displacement of the configuration, change of the momentum) between two ends.
template <DiscreteSystem Sys>
Eigen::VectorXd between(const Sys& system, const TrajectoryPoint<Sys>& from, const TrajectoryPoint<Sys>& to) {
  constexpr int n = Sys::dimension;
  Eigen::VectorXd out(2 * n);
  out << system.groupoid.tau_inverse(
      system.groupoid.multiply(system.groupoid.inverse(from.configuration), to.configuration)),
      to.state.momentum - from.state.momentum;
  return out;
}

/// A state moved along direction k of (v, mu), and the arrow to its object.
template <DiscreteSystem Sys>
auto moved_state(const Sys& system, const State<typename Sys::GroupoidType>& from, int k, double by) {
  using G = typename Sys::GroupoidType;
  std::pair<ArrowOf<G>, State<G>> out{{}, from};
  AlgebroidVector<G> v = AlgebroidVector<G>::Zero();
  (k < Sys::dimension ? v(k) : out.second.momentum(k - Sys::dimension)) += by;
  out.first = system.groupoid.tau(from.object, v);
  out.second.object = system.groupoid.target(out.first);
  return out;
}

/// The directions (v, mu, theta), by differences of the program.
template <DiscreteSystem Sys>
Eigen::MatrixXd differenced(const Sys& system, const State<typename Sys::GroupoidType>& start, long steps) {
  using G = typename Sys::GroupoidType;
  constexpr int n = Sys::dimension;
  constexpr double width = 4e-3;
  const G& groupoid = system.groupoid;
  const auto centre = end_of_run(system, start, steps);
  const int members = int(all_parameters(system).members.size());
  Eigen::MatrixXd out(2 * n, 2 * n + members);
  for (int k = 0; k < 2 * n; ++k)
    out.col(k) = extrapolated_difference(
        [&](double by) {
          const auto [displaced, moved] = moved_state(system, start, k, by);
          auto end = end_of_run(system, moved, steps);
          // Configurations begin where the start's does.
          end.configuration = groupoid.multiply(displaced, end.configuration);
          return between(system, centre, end);
        },
        width);
  for (int j = 0; j < members; ++j)
    out.col(2 * n + j) = extrapolated_difference(
                             [&](double by) {
                               Sys changed = system;
                               auto& member = const_cast<double&>(*all_parameters(changed).members[std::size_t(j)]);
                               member += by * std::max(1.0, std::abs(member));
                               return between(system, centre, end_of_run(changed, start, steps));
                             },
                             width) /
                         std::max(1.0, std::abs(*all_parameters(system).members[std::size_t(j)]));
  return out;
}

/// Throws NotSampled where the run from there fails.
template <class Result> Result converged_run(Result result) {
  if (!result.converged()) throw NotSampled("no run from the state drawn (" + result.message + ")");
  return result;
}

}  // namespace detail

/// What the laws are about. Another in its place shows that they fail.
struct RunDerivatives {
  template <DiscreteSystem Sys>
  auto forward(const Sys& system, const State<typename Sys::GroupoidType>& start,
               const SensitivityOptions<Sys>& options) const {
    return sensitivities(system, start, options);
  }
  template <DiscreteSystem Sys, class F>
  auto backward(const Sys& system, const State<typename Sys::GroupoidType>& start, const F& f,
                const SensitivityOptions<Sys>& options) const {
    return gradient(system, start, f, options);
  }
};

/// How far the transition matrix of a run is from symplectic, relative to the square of its norm.
template <DiscreteSystem Sys, class Derivatives = RunDerivatives>
double symplectic_defect(const Sys& system, const State<typename Sys::GroupoidType>& start, long steps,
                         const Derivatives& derivatives = {}) {
  const auto found = detail::converged_run(derivatives.forward(system, start, SensitivityOptions<Sys>{.steps = steps}));
  const auto end = detail::end_of_run(system, start, steps);
  const Eigen::MatrixXd tangent = detail::tangent_directions(system, start);
  const Eigen::MatrixXd moved = found.by_start * tangent;
  const Eigen::MatrixXd left = moved.transpose() * detail::symplectic_form(system.groupoid, end.state) * moved -
                               tangent.transpose() * detail::symplectic_form(system.groupoid, start) * tangent;
  return left.cwiseAbs().maxCoeff() / std::max(1.0, moved.squaredNorm());
}

/// Of runs of so many steps from random states: `draw()` returns a State.
template <DiscreteSystem Sys, class Draw, class Derivatives = RunDerivatives>
LawReport sensitivity_laws(const Sys& system, const Draw& draw, long steps = 5, const Derivatives& derivatives = {}) {
  using G = typename Sys::GroupoidType;
  const std::vector<std::string> names = all_parameters(system).names;
  LawReport report{"exact derivatives of runs", {}};
  if constexpr (Variational<Sys>)
    report.laws.push_back(check_law("the transition matrix is symplectic", 1e-12,
                                    [&] { return symplectic_defect(system, draw(), steps, derivatives); }));
  report.laws.push_back(check_law("backward is forward", 1e-12, [&] {
    const State<G> start = draw();
    const auto forward = detail::converged_run(
        derivatives.forward(system, start, SensitivityOptions<Sys>{.steps = steps, .parameters = names}));
    const auto momentum = [](const auto& node) { return node.momentum; };
    const auto backward = detail::converged_run(
        derivatives.backward(system, start, momentum, SensitivityOptions<Sys>{.steps = steps, .parameters = names}));
    return worst({detail::relative_defect(backward.by_start, forward.by_start.bottomRows(Sys::dimension)),
                  detail::relative_defect(backward.by_parameters, forward.by_parameters.bottomRows(Sys::dimension))});
  }));
  if constexpr (HasSymmetries<Sys> && !Nonholonomic<Sys>) {
    for (const auto& symmetry : system.symmetries())
      report.laws.push_back(check_law(symmetry.name + " keeps its gradient", 1e-8, [&] {
        const State<G> start = draw();
        const auto found =
            detail::converged_run(derivatives.forward(system, start, SensitivityOptions<Sys>{.steps = steps}));
        const auto slopes = [&](const State<G>& at) {
          Eigen::RowVectorXd out(2 * Sys::dimension);
          for (int k = 0; k < out.size(); ++k)
            out(k) = detail::extrapolated_difference(
                [&](double by) {
                  const State<G> moved = detail::moved_state(system, at, k, by).second;
                  return Eigen::VectorXd(Eigen::VectorXd::Constant(1, symmetry.momentum(moved)));
                },
                1e-2)(0);
          return out;
        };
        const Eigen::MatrixXd tangent = detail::tangent_directions(system, start);
        const auto end = detail::end_of_run(system, start, steps);
        return detail::relative_defect(slopes(end.state) * found.by_start * tangent, slopes(start) * tangent);
      }));
  }
  report.laws.push_back(check_law("differences of the program", 1e-8, [&] {
    const State<G> start = draw();
    const auto found = detail::converged_run(
        derivatives.forward(system, start, SensitivityOptions<Sys>{.steps = steps, .parameters = names}));
    Eigen::MatrixXd all(found.by_start.rows(), found.by_start.cols() + found.by_parameters.cols());
    all << found.by_start, found.by_parameters;
    return detail::relative_defect(all, detail::differenced(system, start, steps));
  }));
  return report;
}

}  // namespace lagroid::laws
