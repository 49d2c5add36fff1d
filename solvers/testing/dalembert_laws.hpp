#pragma once
/// The discrete Lagrange-d'Alembert principle as a property that any system runs by naming itself.

#include <lagroid/solvers/testing/variational_laws.hpp>

#include <limits>

namespace lagroid::laws {

namespace detail {

/// What is left of the principle at the object between two arrows of a trajectory: the virtual work of L and of the
/// forces along D there, relative to the size of its terms.
template <DiscreteSystem Sys>
double virtual_work_defect(const Sys& system, const Step<Sys>& before, const Step<Sys>& after) {
  using V = AlgebroidVector<typename Sys::GroupoidType>;
  V arriving = lagrangian_derivatives(system, before.arrow).second;
  V leaving = lagrangian_derivatives(system, after.arrow).first;
  if constexpr (Forced<Sys>) {
    arriving += system.forces(before.arrow).target;
    leaving += system.forces(after.arrow).source;
  }
  Eigen::VectorXd left = arriving + leaving;
  if constexpr (Nonholonomic<Sys>) {
    const Eigen::MatrixXd omega = annihilator(system, system.groupoid.source(after.arrow));
    left = kernel_of(omega.transpose()).transpose() * left;
  }
  if (!left.allFinite()) return std::numeric_limits<double>::infinity();
  const double noise = size_of_round_off(system, after, two_sided(system, after.arrow, after.multipliers));
  return left.norm() == 0 ? 0 : left.norm() / std::max(noise, arriving.norm() + leaving.norm());
}

}  // namespace detail

/// Along trajectories from random states, for systems that are forced or nonholonomic and have no object constraints:
/// the derivative of the action and the work of the discrete forces vanish along every virtual displacement of an inner
/// node (Cortes & Martinez 2001, Marsden & West 2001, part 3), with derivatives of L by the groupoid's own operations;
/// arrows keep the constraints; the distribution a system writes is that of its constraints; reported momenta differ
/// from the dynamics' own by a reaction, and keep the constraints.
///
/// `draw()` returns a State from which a step can be taken.
template <DiscreteSystem Sys, class Draw>
requires(Sys::object_constraints == 0) LawReport
    dalembert_laws(const Sys& system, const Draw& draw, int count = 5, double tolerance = 1e-10) {
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
  if constexpr (Nonholonomic<Sys>) {
    law("arrows keep the constraints", [&] {
      return along(
          [&](const auto&, const auto& after) { return constraint_values(system, after.arrow).cwiseAbs().maxCoeff(); });
    });
    law("reported momenta keep the constraints", [&] {
      const auto state = legendre_plus(system, step_from(system, draw()));
      auto once = state;
      once.momentum = tangent_momentum(system, state);
      const Eigen::MatrixXd omega = annihilator(system, state.object);
      const Eigen::VectorXd reaction = once.momentum - state.momentum;
      const Eigen::VectorXd across = reaction - omega * omega.colPivHouseholderQr().solve(reaction);
      return worst({detail::relative_defect(tangent_momentum(system, once), once.momentum),
                    across.norm() / (1 + state.momentum.norm())});
    });
  }
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
