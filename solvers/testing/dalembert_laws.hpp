#pragma once
/// The discrete Lagrange-d'Alembert principle as laws of a forced or nonholonomic system,
///
///     <dL, (v, w)> + <f-, v> + <f+, w> = 0  at every inner node, along displacements that annihilators and dC allow,
///
/// with derivatives that share nothing with those of the solvers.
///
///     const ChaplyginSleigh sleigh;
///     const auto draw = [&] { return sleigh.sliding(laws::draw_uniform(), laws::draw_uniform()); };
///     std::cout << laws::dalembert_laws(sleigh, draw);
///
/// Requires states from which a step can be taken. (Cortes and Martinez 2001; Marsden and West 2001, part 3.)

#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/testing/derivative_laws.hpp>
#include <lagroid/solvers/testing/variational_laws.hpp>

#include <limits>

namespace lagroid::laws {

namespace detail {

/// The covectors at the source of `step` that annihilate the virtual displacements there, column by column: those of
/// the distribution and those of object constraints, with derivatives of nested dual numbers.
template <DiscreteSystem Sys> Eigen::MatrixXd reactions_at(const Sys& system, const Step<Sys>& step) {
  const auto d = nested_two_sided(system, step.arrow, step.multipliers);
  if constexpr (Nonholonomic<Sys>) {
    return d.constraint_source;
  } else {
    return d.constraint_source.template rightCols<Sys::object_constraints>();
  }
}

/// What is left of the principle at the object between two arrows of a trajectory: the virtual work of L, of the
/// forces and, of vakonomic constraints, of <lambda, phi>, along admissible displacements there, relative to the size
/// of its terms.
template <DiscreteSystem Sys>
double virtual_work_defect(const Sys& system, const Step<Sys>& before, const Step<Sys>& after) {
  using V = AlgebroidVector<typename Sys::GroupoidType>;
  constexpr int phis = Sys::arrow_constraints;
  V arriving = lagrangian_derivatives(system, before.arrow).second;
  V leaving = lagrangian_derivatives(system, after.arrow).first;
  if constexpr (Forced<Sys>) {
    arriving += system.forces(before.arrow).target;
    leaving += system.forces(after.arrow).source;
  }
  const auto d = two_sided(system, after.arrow, after.multipliers);
  if constexpr (phis > 0 && !Nonholonomic<Sys>) {
    const auto earlier = two_sided(system, before.arrow, before.multipliers);
    arriving +=
        earlier.constraint_target.template topRows<phis>().transpose() * before.multipliers.template head<phis>();
    leaving += d.constraint_source.template leftCols<phis>() * after.multipliers.template head<phis>();
  }
  const Eigen::MatrixXd admissible = kernel_of(reactions_at(system, after).transpose());
  const Eigen::VectorXd left = admissible.transpose() * (arriving + leaving);
  if (!left.allFinite()) return std::numeric_limits<double>::infinity();
  const double noise = size_of_round_off(system, after, d);
  return left.norm() == 0 ? 0 : left.norm() / std::max(noise, arriving.norm() + leaving.norm());
}

/// How far a momentum is from one whose velocity keeps the constraints: what is left of M w - <nu, phi'> = mu - mu_0,
/// <omega, w> + phi(e) = 0, dC w = 0 at the unit e of its object, by least squares in w and, of vakonomic constraints,
/// nu (see constrained_momentum), with the derivatives of nested dual numbers.
template <DiscreteSystem Sys>
double velocity_defect(const Sys& system, const State<typename Sys::GroupoidType>& state) {
  constexpr int n = Sys::dimension;
  constexpr int phis = Sys::arrow_constraints;
  constexpr int unknowns = n + (Nonholonomic<Sys> ? 0 : phis);
  const auto unit = system.groupoid.unit(state.object);
  const auto d = nested_two_sided(system, unit, Sys::Multipliers::Zero().eval());
  const auto [at_source, at_target] = lagrangian_derivatives(system, unit);
  Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(n + Sys::constraints, unknowns);
  Eigen::VectorXd side = Eigen::VectorXd::Zero(n + Sys::constraints);
  equations.topLeftCorner(n, n) = -d.mixed;
  if constexpr (Forced<Sys>) {
    // Forces that depend on the velocity are no part of the mass.
    using D = Dual<double>;
    for (int j = 0; j < n; ++j) {
      Vector<D, n> w = Vector<D, n>::Constant(D(0.0));
      w(j).derivative = 1;
      const auto force = system.forces(system.groupoid.translate(Vector<D, n>(Vector<D, n>::Constant(D(0.0))),
                                                                 system.groupoid.template cast<D>(unit), w));
      for (int i = 0; i < n; ++i) equations(i, j) += force.source(i).derivative;
    }
  }
  if constexpr (Nonholonomic<Sys>) {
    equations.bottomLeftCorner(Sys::constraints, n) = d.constraint_source.transpose();
  } else {
    equations.topRightCorner(n, phis) = -d.constraint_source.template leftCols<phis>();
    equations.bottomLeftCorner(Sys::constraints, n) = d.constraint_target;
  }
  side.head(n) = state.momentum - 0.5 * (at_target - at_source);
  side.segment(n, phis) = -d.constraint.template head<phis>();
  const auto scaling = Scaling<Eigen::Dynamic, Eigen::Dynamic>::equilibrate(equations);
  const Eigen::MatrixXd scaled = scaling.apply(equations);
  const Eigen::VectorXd scaled_side = scaling.row.asDiagonal() * side;
  const Eigen::VectorXd left = scaled * least_squares(scaled, scaled_side) - scaled_side;
  if (!left.allFinite()) return std::numeric_limits<double>::infinity();
  return left.norm() == 0 ? 0 : left.norm() / std::max(scaled_side.norm(), std::numeric_limits<double>::min());
}

}  // namespace detail

/// Along trajectories from random states, for systems that are forced or nonholonomic: the derivative of the action and
/// the work of the discrete forces vanish along every virtual displacement of an inner node that object constraints
/// allow (Cortes & Martinez 2001, Marsden & West 2001, part 3), with derivatives of L by the groupoid's own operations;
/// arrows keep the constraints; the distribution a system writes is that of its constraints; reported momenta differ
/// from the dynamics' own by a reaction, and have a velocity that keeps the constraints.
///
/// `draw()` returns a State from which a step can be taken.
template <DiscreteSystem Sys, class Draw>
LawReport dalembert_laws(const Sys& system, const Draw& draw, int count = 5, double tolerance = 1e-10) {
  LawReport report{"Lagrange-d'Alembert principle", {}};
  const auto law = [&](const char* name, const auto& defect) {
    report.laws.push_back(check_law(name, tolerance, defect));
  };
  /// The largest of `defect(step before, step after)` along a trajectory.
  const auto along = [&](const auto& defect) {
    auto integrator = detail::newton_integrator(system, draw());
    double largest = 0;
    Step<Sys> before;
    for (int k = 0; k < count; ++k) {
      if (const auto found = integrator.advance(); !found.converged()) throw detail::no_step(found);
      if (k > 0) largest = worst({largest, defect(before, integrator.point().step)});
      before = integrator.point().step;
    }
    return largest;
  };
  law("no virtual work", [&] {
    return along(
        [&](const auto& before, const auto& after) { return detail::virtual_work_defect(system, before, after); });
  });
  if constexpr (Sys::constraints > 0)
    law("arrows keep the constraints", [&] {
      return along(
          [&](const auto&, const auto& after) { return constraint_values(system, after.arrow).cwiseAbs().maxCoeff(); });
    });
  if constexpr (Nonholonomic<Sys> || Sys::object_constraints > 0)
    law("reported momenta keep the constraints", [&] {
      const auto state = legendre_plus(system, step_from(system, draw()));
      auto reported = state;
      reported.momentum = tangent_momentum(system, state);
      const Step<Sys> rest{system.groupoid.unit(state.object), Sys::Multipliers::Zero()};
      const Eigen::MatrixXd reactions = detail::reactions_at(system, rest);
      const Eigen::VectorXd reaction = reported.momentum - state.momentum;
      const Eigen::VectorXd across = reaction - reactions * least_squares(reactions, reaction);
      return worst({detail::velocity_defect(system, reported), across.norm() / (1 + state.momentum.norm())});
    });
  if constexpr (HasAnnihilator<Sys>)
    law("the distribution is that of the constraints", [&] {
      const auto q = draw().object;
      const Eigen::MatrixXd written = annihilator(system, q);
      const Eigen::MatrixXd deduced = deduced_annihilator(system, q);
      // Spans are compared: multipliers may be scaled.
      const Eigen::MatrixXd basis = detail::kernel_of(deduced.transpose());
      return (basis.transpose() * written).norm() / written.norm();
    });
  return report;
}

}  // namespace lagroid::laws
