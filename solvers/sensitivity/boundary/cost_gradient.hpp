#pragma once
/// How the least cost of a boundary value depends on its ends and on the parameters. Along a stationary path nothing is
/// gained by moving inner nodes, so that (envelope theorem)
///
///     J(g) = sum_k L(g_k),    phi(g_k) = 0,    g_1 ... g_N = g,
///     dJ = -<mu_0, v> + <mu_N, w> + sum_k d_theta (L + <lambda, phi>)(g_k) dtheta
///
/// where the ends move by tau(v)^{-1} g tau(w), mu_0 = F-(g_1, lambda) and mu_N = F+(g_N, lambda) being the momenta
/// there. No system of equations is solved for it. Optimal control with equality constraints is such a boundary value,
/// its multipliers are those of the path.
///
///     const auto found = solve_boundary(*make_boundary_solver<Kepler>(), problem, 100);
///     const CostGradient cost = cost_gradient(problem.system, found.solutions.front().path, {"strength"});
///     const double by_strength = cost.by_parameters(0);
///
/// Requires a stationary path of equal steps. Errors: std::invalid_argument for a name that is no parameter;
/// WithoutDerivative for one by which the ends leave their object constraints, or that the system reads as a plain
/// number. Source: [G] Def. 3.3; envelope theorem.

#include <lagroid/core/derivatives/two_sided.hpp>
#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/solvers/boundary/boundary_problem.hpp>
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

struct CostGradient {
  double cost = 0;
  Eigen::RowVectorXd by_start;  ///< along v at the source of the first arrow
  Eigen::RowVectorXd by_end;    ///< along w at the target of the last
  std::vector<std::string> parameters;
  Eigen::RowVectorXd by_parameters;
};

namespace detail {

/// sum_k (L + <lambda, phi>)(g_k) over V, a plain number or one with derivatives.
template <class V, DiscreteSystem Sys> V augmented_action(const Sys& system, const Path<Sys>& path) {
  V sum(0.0);
  for (const Step<Sys>& step : path)
    sum += augmented_lagrangian<V>(system, system.groupoid.template cast<V>(step.arrow), step.multipliers);
  return sum;
}

/// Throws WithoutDerivative for a parameter by which an end would leave its object constraints.
template <DiscreteSystem Sys>
void require_ends_that_stay(const Sys& system, const Path<Sys>& path, const ParameterPlaces& places, int first) {
  if constexpr (Sys::object_constraints > 0) {
    const auto& groupoid = system.groupoid;
    for (const auto& end : {groupoid.source(path.front().arrow), groupoid.target(path.back().arrow)}) {
      const auto at = system.object_constraint(groupoid.template cast_object<VariedNumber>(end));
      for (int a = 0; a < Sys::object_constraints; ++a)
        for (int k = first; k < std::min(int(places.names.size()), first + varied_at_once); ++k)
          if (at(a).tangent(k - first) != 0)
            throw WithoutDerivative("the ends would leave their constraints for another " +
                                    places.names[std::size_t(k)] + ": the cost has no derivative by it");
    }
  }
}

}  // namespace detail

template <Variational Sys>
CostGradient cost_gradient(Sys system, const Path<Sys>& path, const std::vector<std::string>& parameters = {}) {
  if (path.empty()) throw std::invalid_argument("a path without arrows has no cost");
  CostGradient out;
  out.cost = action(system, path);
  const Step<Sys>& first_step = path.front();
  const Step<Sys>& last_step = path.back();
  out.by_start = gradients(system, first_step.arrow, first_step.multipliers).source_gradient.transpose();
  out.by_end = gradients(system, last_step.arrow, last_step.multipliers).target_gradient.transpose();
  const ParameterPlaces places = places_of_parameters(system, parameters);
  out.parameters = places.names;
  const int count = int(places.members.size());
  out.by_parameters.resize(count);
  detail::for_directions(count, [&](int first) {
    const VariedMembers varying(places.members, -first);
    detail::require_ends_that_stay(system, path, places, first);
    const VariedNumber sum = detail::augmented_action<VariedNumber>(system, path);
    for (int k = first; k < std::min(count, first + varied_at_once); ++k) out.by_parameters(k) = sum.tangent(k - first);
  });
  for (int k = 0; k < count; ++k) {
    double& member = const_cast<double&>(*places.members[std::size_t(k)]);  // of `system`, which is no constant
    const double here = member;
    const auto at = [&](double value) {
      member = value;
      const double sum = detail::augmented_action<double>(system, path);
      member = here;
      return sum;
    };
    const double width = 1e-4 * (here == 0 ? 1 : std::abs(here));
    const auto difference = [&](double by) -> Eigen::VectorXd {
      return Eigen::VectorXd::Constant(1, (at(here + by) - at(here - by)) / (2 * by));
    };
    detail::require_derivative(places.names[std::size_t(k)], out.by_parameters.segment(k, 1).transpose(),
                               difference(width), difference(width / 2), std::abs(at(here)) / width);
  }
  return out;
}

}  // namespace lagroid
