#pragma once
/// Shooting: Newton's method on the initial momentum mu_0 of a trajectory whose end is given,
///
///     mu_0 <- mu_0 + S^{-1} tau^{-1}((g_1 ... g_N)^{-1} g),    S = d(end node) / d(mu_0).
///
/// It checks BoundaryNewton by other means, and is good where trajectories depend mildly on their start.
///
///     const BoundaryProblem<Kepler> problem{Kepler{}, {{1, 0}, {-0.3, 0.8}}};
///     const BoundaryShooting<Kepler> shooting;
///     const auto found = shooting.solve(problem, geodesic_path(problem, 100), false);
///
/// Requirements and result are those of boundary_solver.hpp. Status: `stagnated` (no change of mu_0 brings the end
/// nearer), `not_converged`, `not_finite`, or that of the step that failed on the way, with a message that names the
/// remedy.

#include <lagroid/core/derivatives/step_equations.hpp>
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/solvers/boundary/boundary_newton.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/linear_algebra/factored_square.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

namespace lagroid {

/// d(end node)/d(initial momentum) along a trajectory: the matrix that takes dmu_0 to v_N, the displacement of the last
/// node in A_{q_N}G. The step equations linearised in the nodes' frames, exact at a trajectory: with u = v_{k-1},
///
///     [ -M_k  -A_k ; B_k  0 ] (v_k, dlambda_k) = ( (S_k + T_{k-1}) u + M_{k-1}^T v_{k-2} + dphi_{k-1}^T dlambda_{k-1},
///                                                  -dphi_k u )
///
/// with M the mixed, S and T the one-sided Hessians at source and target, A and B the constraints' derivatives there.
template <DiscreteSystem Sys>
Matrix<double, Sys::dimension, Sys::dimension> end_sensitivity(const Sys& system, const Path<Sys>& trajectory) {
  constexpr int n = Sys::dimension;
  constexpr int m = Sys::constraints;
  constexpr int phis = Sys::arrow_constraints;
  using Square = Matrix<double, n, n>;
  Square before = Square::Zero();  // v_{k-2}
  Square u = Square::Zero();       // v_{k-1}
  Matrix<double, m, n> dlambda = Matrix<double, m, n>::Zero();
  std::optional<SecondDerivativesOf<Sys>> last;
  for (const auto& step : trajectory) {
    const auto d = second_derivatives(system, step.arrow, step.multipliers);
    Matrix<double, n + m, n> right = Matrix<double, n + m, n>::Zero();
    if (last) {
      right.template topRows<n>() =
          (d.source_hessian + last->target_hessian) * u + last->mixed.transpose() * before +
          last->constraint_target.template topRows<phis>().transpose() * dlambda.template topRows<phis>();
      right.template middleRows<phis>(n) = -d.constraint_source.template leftCols<phis>().transpose() * u;
    } else {
      right.template topRows<n>().setIdentity();
    }
    FactoredSquare<n + m> lu;
    lu.compute(StepEquations<Sys>::jacobian(d));
    before = u;
    for (int j = 0; j < n; ++j) {
      typename FactoredSquare<n + m>::Column column;
      for (int i = 0; i < n + m; ++i) column(i) = right(i, j);
      const auto solved = lu.solve(column);
      for (int i = 0; i < n; ++i) u(i, j) = solved(i);
      for (int i = 0; i < m; ++i) dlambda(i, j) = solved(n + i);
    }
    last = d;
  }
  return u;
}

/// Newton's method on the initial momentum: the trajectory is the integrator's, its sensitivity exact, a step is halved
/// until the miss at the end falls. With object constraints the momentum is determined up to their normals, and the
/// least change is taken. Good where trajectories depend mildly on their start; elsewhere sensitivities grow like the
/// flow's own and it fails, with a typed status, where BoundaryNewton, which holds the whole path, does not.
template <DiscreteSystem Sys> class BoundaryShooting final : public BoundarySolver<Sys> {
 public:
  using G = typename Sys::GroupoidType;

  using BoundarySolver<Sys>::BoundarySolver;

 private:
  /// The initial momentum to start from is F- of the path's first arrow.
  BoundarySolution<Sys> solve_from(const BoundaryProblem<Sys>& problem, Path<Sys> path,
                                   bool keep_multipliers) const override {
    const Sys& system = problem.system;
    BoundarySolution<Sys> out;
    if (!keep_multipliers) {
      out = BoundaryNewton<Sys>(options_, stationary_kind_).prepare(problem, std::move(path));
      if (!out.converged()) return out;
      path = std::move(out.path);
    }
    AlgebroidVector<G> momentum = initial_momentum(system, path);
    Shot shot = shoot(problem, path.size(), momentum);
    out.status = shot.status;
    out.path = std::move(path);
    while (shot.status == SolveStatus::converged) {
      if (++out.iterations > options_.max_iterations) {
        out.status = SolveStatus::not_converged;
        break;
      }
      const auto sensitivity = end_sensitivity(system, shot.path);
      const AlgebroidVector<G> change = least_change(sensitivity, shot.miss);
      Shot next;
      bool advanced = false;
      double fraction = 1;
      for (int halving = 0; halving < 20 && !advanced; ++halving, fraction /= 2) {
        const AlgebroidVector<G> trial = momentum + fraction * change;
        next = shoot(problem, out.path.size(), trial);
        advanced = next.status == SolveStatus::converged && next.miss.norm() < (1 - 0.1 * fraction) * shot.miss.norm();
        if (advanced) momentum = trial;
      }
      if (!advanced) {
        out.status = SolveStatus::stagnated;
        break;
      }
      shot = std::move(next);
    }
    // Round-off ends every iteration; the equations say whether it was at a solution.
    if (!shot.path.empty()) out.path = closed(problem, std::move(shot.path));
    BoundaryKkt<Sys> kkt;
    kkt.evaluate(system, out.path);
    kkt.choose_scale();
    out.residual = kkt.residual_norm();
    if (!std::isfinite(out.residual)) {
      out.status = SolveStatus::not_finite;
    } else if (out.residual <= options_.tolerance) {
      out.status = SolveStatus::converged;
      this->describe(system, kkt, out);
    } else {
      out.message = failure(out.status, out.iterations, shot.miss.norm());
    }
    return out;
  }

  using BoundarySolver<Sys>::options_;
  using BoundarySolver<Sys>::stationary_kind_;

  /// A trajectory from a momentum, and the displacement of its end that would reach the boundary.
  struct Shot {
    SolveStatus status = SolveStatus::not_converged;
    Path<Sys> path;
    AlgebroidVector<G> miss = AlgebroidVector<G>::Constant(std::numeric_limits<double>::infinity());
  };

  static std::string failure(SolveStatus status, int iterations, double miss) {
    switch (status) {
      case SolveStatus::not_converged:
        return fmt::format(
            "shooting: the end is still missed by {:.2e} after {} iterations; raise solver.max_iterations or use "
            "solver.method = \"newton\"",
            miss, iterations - 1);
      case SolveStatus::stagnated:
        return fmt::format(
            "shooting: the end is missed by {:.2e} and no change of the initial momentum lowers that; use "
            "solver.method = \"newton\"",
            miss);
      default:
        return fmt::format(
            "shooting: a step of the trajectory from the first guess failed ({}); use solver.method = \"newton\" or "
            "more steps",
            to_string(status));
    }
  }

  /// dmu with S dmu = miss; of least norm, in the sense of least squares, where object constraints make S singular.
  static AlgebroidVector<G> least_change(const Matrix<double, Sys::dimension, Sys::dimension>& sensitivity,
                                         const AlgebroidVector<G>& miss) {
    if constexpr (Sys::object_constraints == 0) {
      return solve_regular(sensitivity, miss);
    } else {
      return least_squares(sensitivity, miss);
    }
  }

  static Shot shoot(const BoundaryProblem<Sys>& problem, std::size_t count, const AlgebroidVector<G>& momentum) {
    const G& groupoid = problem.system.groupoid;
    const auto start = groupoid.source(problem.boundary);
    FixedStepIntegrator<Sys> integrator(problem.system, {start, momentum}, groupoid.unit(start),
                                        std::make_unique<NewtonStep<Sys>>());
    Shot shot;
    Path<Sys> path;
    for (std::size_t k = 0; k < count; ++k) {
      const StepReport report = integrator.advance();
      shot.status = report.status;
      if (!report.converged()) return shot;
      path.push_back(integrator.point().step);
    }
    shot.path = std::move(path);
    shot.miss =
        groupoid.tau_inverse(groupoid.compose(groupoid.inverse(integrator.point().configuration), problem.boundary));
    if (!shot.miss.allFinite()) shot.status = SolveStatus::not_finite;
    return shot;
  }

  /// The trajectory with its last arrow ending where it must, and no impulse at the first object.
  static Path<Sys> closed(const BoundaryProblem<Sys>& problem, Path<Sys> path) {
    path.front().multipliers.template tail<Sys::object_constraints>().setZero();
    return displaced(problem, path, Variation<Sys>(path.size()), 0.0);
  }
};

}  // namespace lagroid
