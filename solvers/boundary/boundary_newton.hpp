#pragma once
/// Newton's method for a boundary-value problem, on the equations of the whole path at once:
///
///     F+(g_k, lambda_k) = F-(g_{k+1}, lambda_{k+1}),    phi(g_k) = 0,    C(q_k) = 0,    g_1 ... g_N = g.
///
/// It is the default: linear in N, quadratically convergent, and globalised by descent of the action (for minima) or of
/// the residual (for stationary paths), so that rough guesses do.
///
///     const BoundaryProblem<Kepler> problem{Kepler{}, {{1, 0}, {-0.3, 0.8}}};
///     const BoundaryNewton<Kepler> newton;
///     const auto found = newton.solve(problem, geodesic_path(problem, 100), false);
///
/// Requirements and result are those of boundary_solver.hpp. Status: `stagnated` (no step lowers action or residual),
/// `not_converged` (limit of iterations), `not_finite`. [G] section 5, Theorem 5.1

#include <lagroid/solvers/boundary/boundary_kkt.hpp>
#include <lagroid/solvers/boundary/boundary_solver.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid {

/// Newton's method on the manifold of admissible trajectories ([G] 5.1): composable arrows in the constraint set with
/// the given product.
///
/// First the path is brought onto that manifold by Gauss-Newton steps of least norm. Then, looking for minima, at each
/// iteration the KKT matrix with exact second derivatives gets just enough of the identity on its Hessian block to have
/// the inertia of a minimum on the tangent space (section 5.1's space of variations), a step along its solution is
/// pulled back to the manifold with the same matrix, and the action itself decides how far to go; looking for
/// stationary points, the step is Newton's, damped until the residual or the next Newton correction falls. Near a
/// solution plain Newton on the full KKT system takes over, down to a thousandth of the tolerance.
template <DiscreteSystem Sys> class BoundaryNewton final : public BoundarySolver<Sys> {
 public:
  static constexpr int n = Sys::dimension;
  static constexpr int m = Sys::constraints;
  using BoundarySolver<Sys>::BoundarySolver;

  /// The path brought onto the constraints, with its least-squares multipliers; `converged` if that succeeded.
  BoundarySolution<Sys> prepare(const BoundaryProblem<Sys>& problem, Path<Sys> path) const {
    Work work;
    BoundarySolution<Sys> out;
    if (restore(problem, work, path, out) && least_squares_multipliers(problem, work, path, out))
      out.status = SolveStatus::converged;
    out.path = std::move(path);
    evaluate_residual(problem.system, work.kkt, out);
    return out;
  }

 private:
  BoundarySolution<Sys> solve_from(const BoundaryProblem<Sys>& problem, Path<Sys> path,
                                   bool keep_multipliers) const override {
    Work work;
    BoundarySolution<Sys> out;
    const Sys& system = problem.system;
    if (keep_multipliers) polish(problem, work, path, out);
    if (!out.converged() && restore(problem, work, path, out)) {
      if (stationary_kind_ == StationaryKind::minima) {
        find_minimum(problem, work, path, out);
      } else {
        find_stationary(problem, work, path, out);
      }
    }
    out.path = std::move(path);
    if (out.converged()) {
      this->describe(system, work.kkt, out);
    } else {
      evaluate_residual(system, work.kkt, out);
    }
    return out;
  }

  using BoundarySolver<Sys>::options_;
  using BoundarySolver<Sys>::stationary_kind_;
  using Kkt = BoundaryKkt<Sys>;
  using Columns = typename Kkt::Columns;

  /// Everything an iteration writes to.
  struct Work {
    Kkt kkt;
    Columns side;
    Columns step;
    Columns defect;
    Variation<Sys> variation;
    Path<Sys> trial;
  };

  static bool fail(BoundarySolution<Sys>& out, SolveStatus status) {
    out.status = status;
    return false;
  }

  static void evaluate_residual(const Sys& system, Kkt& kkt, BoundarySolution<Sys>& out) {
    kkt.evaluate(system, out.path);
    kkt.choose_scale();
    out.residual = kkt.residual_norm();
  }

  static double square(const Columns& c) {
    double sum = 0;
    for (const auto& x : c) sum += x.squaredNorm();
    return sum;
  }

  static void without_multipliers(Variation<Sys>& v) {
    for (auto& l : v.multipliers) l.setZero();
  }

  /// Damped Gauss-Newton steps of least norm until the path is admissible.
  bool restore(const BoundaryProblem<Sys>& problem, Work& work, Path<Sys>& path, BoundarySolution<Sys>& out) const {
    const Sys& system = problem.system;
    Kkt& kkt = work.kkt;
    for (; out.iterations < options_.max_iterations; ++out.iterations) {
      kkt.evaluate(system, path, Kkt::Hessian::stiffness);
      if (!std::isfinite(kkt.residual_norm())) return fail(out, SolveStatus::not_finite);
      kkt.choose_scale();
      const double violation = kkt.constraint_side(system, path, work.side);
      if (violation <= options_.feasibility && admissible(system, path)) return true;
      kkt.factor(0, 1e-10);
      solve_side(work);
      without_multipliers(work.variation);
      double fraction = std::min(1.0, options_.largest_displacement / reach(work.variation));
      bool advanced = false;
      for (int halving = 0; halving < 30 && !advanced; ++halving, fraction /= 2) {
        displace(problem, path, work.variation, fraction, work.trial);
        kkt.constraint_side(system, work.trial, work.step);
        advanced = square(work.step) < (1 - 0.1 * fraction) * square(work.side);
      }
      if (!advanced) return fail(out, SolveStatus::stagnated);
      std::swap(path, work.trial);
    }
    return fail(out, SolveStatus::not_converged);
  }

  bool least_squares_multipliers(const BoundaryProblem<Sys>& problem, Work& work, Path<Sys>& path,
                                 BoundarySolution<Sys>& out) const {
    if constexpr (m > 0) {
      for (auto& step : path) step.multipliers.setZero();
      work.kkt.evaluate(problem.system, path, Kkt::Hessian::stiffness);
      if (!std::isfinite(work.kkt.residual_norm())) return fail(out, SolveStatus::not_finite);
      work.kkt.choose_scale();
      work.kkt.factor(0, 1e-8);
      work.kkt.newton_side(work.side);
      solve_side(work);
      for (std::size_t k = 0; k < path.size(); ++k) path[k].multipliers = work.variation.multipliers[k];
    }
    return true;
  }

  void find_minimum(const BoundaryProblem<Sys>& problem, Work& work, Path<Sys>& path,
                    BoundarySolution<Sys>& out) const {
    double shift = 0;
    while (out.iterations < options_.max_iterations) {
      if (!least_squares_multipliers(problem, work, path, out)) return;
      work.kkt.evaluate(problem.system, path);
      if (work.kkt.residual_norm() < 2.0 / double(path.size())) {
        if (polish(problem, work, path, out)) return;
        work.kkt.evaluate(problem.system, path);
      }
      if (!descend(problem, work, path, shift, out)) {
        settle(problem, work, path, out);
        return;
      }
    }
    out.status = SolveStatus::not_converged;
  }

  /// Newton's iteration, damped: a step is taken as far as it lowers the residual or, in the spirit of Deuflhard's
  /// natural monotonicity test, the correction the same matrix would make next, which is small also where scales
  /// differ.
  void find_stationary(const BoundaryProblem<Sys>& problem, Work& work, Path<Sys>& path,
                       BoundarySolution<Sys>& out) const {
    const Sys& system = problem.system;
    Kkt& kkt = work.kkt;
    if (!least_squares_multipliers(problem, work, path, out)) return;
    for (; out.iterations < options_.max_iterations; ++out.iterations) {
      kkt.evaluate(system, path);
      kkt.choose_scale();
      if (!std::isfinite(kkt.residual_norm())) {
        out.status = SolveStatus::not_finite;
        return;
      }
      if (kkt.residual_norm() < 1e-3) {
        if (polish(problem, work, path, out)) return;
        kkt.evaluate(system, path);
        kkt.choose_scale();
      }
      kkt.newton_side(work.side);
      factor_plainly(kkt);
      solve_side(work);
      const double residual = square(work.side);
      const double correction = square(work.step);
      double fraction = std::min(1.0, options_.largest_displacement / reach(work.variation));
      bool advanced = false;
      for (int halving = 0; halving < 30 && !advanced; ++halving, fraction /= 2) {
        displace(problem, path, work.variation, fraction, work.trial);
        if (!admissible(system, work.trial)) continue;
        kkt.evaluate(system, work.trial);
        kkt.newton_side(work.defect);
        const double next = square(work.defect);
        if (!std::isfinite(next)) continue;
        advanced = next < (1 - 0.1 * fraction) * residual;
        if (advanced) break;
        kkt.solve_in_place(work.defect);
        advanced = square(work.defect) < (1 - 0.5 * fraction) * correction;
      }
      if (!advanced) {
        out.status = SolveStatus::stagnated;
        return;
      }
      std::swap(path, work.trial);
    }
    out.status = SolveStatus::not_converged;
  }

  /// One step of descent of the action along the manifold, by the least shift (of the right inertia) whose step stays
  /// in reach, comes back to the constraints and lowers the action. On entry the KKT system is evaluated at `path`;
  /// `shift` is the one that served last.
  bool descend(const BoundaryProblem<Sys>& problem, Work& work, Path<Sys>& path, double& shift,
               BoundarySolution<Sys>& out) const {
    const Sys& system = problem.system;
    Kkt& kkt = work.kkt;
    ++out.iterations;
    kkt.choose_scale();
    kkt.newton_side(work.side);
    const double cost = action(system, path);
    constexpr double smallest = 1e-3;
    constexpr double largest = 1e8;
    shift = shift / 3 < smallest ? 0 : shift / 3;
    for (; shift < largest; shift = std::max(smallest, 3 * shift)) {
      if (!right_inertia(kkt, shift)) continue;
      solve_side(work);
      without_multipliers(work.variation);
      if (reach(work.variation) > options_.largest_displacement) continue;
      double slope = 0;
      for (std::size_t k = 0; k < path.size(); ++k) slope += kkt.cost_gradient()[k].dot(work.variation.nodes[k]);
      Path<Sys> trial;
      displace(problem, path, work.variation, 1.0, trial);
      if (pull_back(problem, work, trial) && action(system, trial) <= cost + 1e-4 * slope) {
        path = std::move(trial);
        return true;
      }
    }
    return fail(out, SolveStatus::stagnated);
  }

  /// Chord iterations with the factored matrix back to the constraints; false where they do not contract.
  bool pull_back(const BoundaryProblem<Sys>& problem, Work& work, Path<Sys>& path) const {
    const Sys& system = problem.system;
    double violation = work.kkt.constraint_side(system, path, work.step);
    for (int iteration = 0; iteration < 20; ++iteration) {
      if (!std::isfinite(violation)) return false;
      if (violation <= options_.feasibility) return admissible(system, path);
      work.kkt.solve_in_place(work.step);
      work.kkt.unscale(work.step, work.variation);
      without_multipliers(work.variation);
      displace(problem, path, work.variation, 1.0, work.trial);
      std::swap(path, work.trial);
      const double before = violation;
      violation = work.kkt.constraint_side(system, path, work.step);
      if (!(violation < 0.7 * before)) return false;
    }
    return false;
  }

  /// Newton on the full KKT system while it contracts; converged, or the path as it was.
  bool polish(const BoundaryProblem<Sys>& problem, Work& work, Path<Sys>& path, BoundarySolution<Sys>& out) const {
    const Sys& system = problem.system;
    Kkt& kkt = work.kkt;
    Path<Sys> best = path;
    kkt.evaluate(system, best);
    kkt.choose_scale();
    double norm = kkt.residual_norm();
    int iterations = 0;
    // Quadratic convergence: one iteration from the tolerance ends at round-off.
    const double finished = 1e-3 * options_.tolerance;
    bool last = false;
    for (bool contracts = true; contracts && !last && norm > finished && iterations < 30; ++iterations) {
      last = norm <= options_.tolerance;
      factor_plainly(kkt);
      kkt.newton_side(work.side);
      solve_side(work, /*refine=*/last);
      if (reach(work.variation) > options_.largest_displacement) break;
      displace(problem, best, work.variation, 1.0, work.trial);
      kkt.evaluate(system, work.trial);
      const double next = kkt.residual_norm();
      contracts = next < 0.5 * norm && admissible(system, work.trial);
      if (contracts) {
        std::swap(best, work.trial);
        norm = next;
      }
    }
    out.iterations += iterations;
    if (!(norm <= options_.tolerance)) return false;
    path = std::move(best);
    out.residual = norm;
    out.status = SolveStatus::converged;
    return true;
  }

  /// Where the constraints lose rank (an abnormal extremal), paths cannot be pulled back to them: Newton on the KKT
  /// system with both blocks regularised in proportion to the residual, then plainly.
  void settle(const BoundaryProblem<Sys>& problem, Work& work, Path<Sys>& path, BoundarySolution<Sys>& out) const {
    const Sys& system = problem.system;
    Kkt& kkt = work.kkt;
    kkt.evaluate(system, path);
    kkt.choose_scale();
    double norm = kkt.residual_norm();
    for (int failures = 0; failures < 8 && out.iterations < options_.max_iterations && norm > 1e-6;) {
      ++out.iterations;
      const double regularisation = std::pow(4.0, failures) * 0.1 * norm;
      double primal = regularisation;
      while (kkt.factor(primal, regularisation).negative != kkt.constraint_count() && primal < 1e6) primal *= 4;
      kkt.newton_side(work.side);
      solve_side(work);
      displace(problem, path, work.variation,
               std::min(1.0, options_.largest_displacement / std::max(1e-300, reach(work.variation))), work.trial);
      Kkt there = kkt;
      there.evaluate(system, work.trial);
      const double next = there.residual_norm();
      if (next < norm && admissible(system, work.trial)) {
        std::swap(path, work.trial);
        kkt = std::move(there);
        norm = next;
        failures = 0;
      } else {
        ++failures;
      }
    }
    out.status = out.iterations < options_.max_iterations ? SolveStatus::stagnated : SolveStatus::not_converged;
    polish(problem, work, path, out);
  }

  /// Solves for `side` with the factored matrix; the solution is left in `step` and, unscaled, in `variation`.
  static void solve_side(Work& work, bool refine = false) {
    work.step = work.side;
    work.kkt.solve_in_place(work.step);
    if (refine) {
      work.defect = work.side;
      work.kkt.add_product(-1, work.step, work.defect);
      work.kkt.solve_in_place(work.defect);
      for (std::size_t k = 0; k < work.step.size(); ++k) work.step[k] += work.defect[k];
    }
    work.kkt.unscale(work.step, work.variation);
  }

  static constexpr double tiny_pivot = 1e-11;
  static constexpr double dual_shift = 1e-9;

  static void factor_plainly(Kkt& kkt) {
    if (kkt.factor(0, 0).smallest < tiny_pivot) kkt.factor(dual_shift, dual_shift);
  }

  /// Factors with the given shift; true when as many eigenvalues are negative as there are constraints, as at a minimum
  /// on the tangent space.
  static bool right_inertia(Kkt& kkt, double shift) {
    auto inertia = kkt.factor(0, 0, shift);
    if (inertia.smallest < tiny_pivot) inertia = kkt.factor(0, dual_shift, shift);
    return inertia.negative == kkt.constraint_count();
  }

  /// How far the node that moves most moves.
  static double reach(const Variation<Sys>& variation) {
    double largest = 0;
    for (const auto& v : variation.nodes) largest = std::max(largest, v.norm());
    return largest;
  }

  static bool admissible(const Sys& system, const Path<Sys>& path) {
    if constexpr (HasBranch<Sys>) {
      return std::all_of(path.begin(), path.end(), [&](const Step<Sys>& s) { return system.admissible(s.arrow); });
    } else {
      return true;
    }
  }
};

}  // namespace lagroid
