#pragma once
/// Boundary-value problems by Newton's method on the full KKT system, globalised.

#include <lagroid/solvers/boundary_kkt.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid {

struct BoundaryOptions {
  int max_iterations = 200;
  double tolerance = 1e-10;   ///< on the scaled residual, for `converged`; iterates on until it no longer falls
  double feasibility = 1e-9;  ///< largest scaled constraint value at which a path counts as admissible on the way
  double largest_displacement = 1.0;  ///< bound on a node displacement in one iteration, in coordinates of AG
};

/// Newton's method on the manifold of admissible trajectories ([G] 5.1): composable arrows in the constraint set with
/// the given product.
///
/// First the path is brought onto that manifold by Gauss-Newton steps of least norm. Then, at each iteration, the KKT
/// matrix with exact second derivatives gets just enough of the identity on its Hessian block to have the inertia of a
/// minimum on the tangent space (section 5.1's space of variations), a step along its solution is pulled back to the
/// manifold with the same matrix, and the action itself decides how far to go. Near a solution plain Newton on the full
/// KKT system takes over and is iterated to round-off.
template <DiscreteSystem Sys> class BoundaryNewton {
 public:
  static constexpr int n = Sys::dimension;
  static constexpr int m = Sys::constraints;

  explicit BoundaryNewton(BoundaryOptions options = {}) : options_(options) {}

  /// Starts from `path`, whose product must be the boundary arrow. Multipliers are found from the arrows unless
  /// `keep_multipliers` says that those of `path` are worth starting from.
  BoundarySolution<Sys> solve(const BoundaryProblem<Sys>& problem, Path<Sys> path, bool keep_multipliers) const {
    BoundaryKkt<Sys> kkt;
    BoundarySolution<Sys> out;
    const Sys& system = problem.system;
    double shift = 0;
    if (keep_multipliers) polish(problem, kkt, path, out);
    if (!out.converged()) {
      if (!restore(problem, kkt, path, out)) return out;
      while (out.iterations < options_.max_iterations) {
        if (!least_squares_multipliers(problem, kkt, path)) return fail(out, SolveStatus::not_finite, path);
        kkt.evaluate(system, path);
        if (kkt.residual_norm() < 0.1) {
          if (polish(problem, kkt, path, out)) break;
          kkt.evaluate(system, path);
        }
        if (!descend(problem, kkt, path, shift, out)) {
          settle(problem, kkt, path, out);
          break;
        }
      }
    }
    if (!out.converged()) {
      if (out.iterations >= options_.max_iterations) out.status = SolveStatus::not_converged;
      kkt.evaluate(system, path);
      kkt.choose_scale();
      out.residual = kkt.residual_norm();
      out.path = std::move(path);
      return out;
    }
    out.cost = action(system, path);
    kkt.evaluate(system, path);
    kkt.choose_scale();
    out.kind = kkt.classify(system, path);
    out.path = std::move(path);
    return out;
  }

  /// The path brought onto the constraints, with its least-squares multipliers; `converged` if that succeeded.
  BoundarySolution<Sys> prepare(const BoundaryProblem<Sys>& problem, Path<Sys> path) const {
    Kkt kkt;
    BoundarySolution<Sys> out;
    if (!restore(problem, kkt, path, out)) return out;
    if (!least_squares_multipliers(problem, kkt, path)) return fail(out, SolveStatus::not_finite, path);
    out.status = SolveStatus::converged;
    out.path = std::move(path);
    return out;
  }

 private:
  using Kkt = BoundaryKkt<Sys>;
  using Columns = typename Kkt::Columns;
  struct Direction {
    std::vector<Vector<double, n>> nodes;
    std::vector<typename Sys::Multipliers> multipliers;
  };

  static BoundarySolution<Sys>& fail(BoundarySolution<Sys>& out, SolveStatus status, const Path<Sys>& path) {
    out.status = status;
    out.path = path;
    return out;
  }

  static Columns negated(Columns c) {
    for (auto& x : c) x = -x;
    return c;
  }

  static Direction unscaled(const Kkt& kkt, const Columns& z) {
    Direction d;
    d.nodes.reserve(z.size());
    d.multipliers.reserve(z.size());
    for (const auto& c : z) {
      const typename Kkt::Column x = kkt.scale().cwiseProduct(c);
      d.multipliers.push_back(x.template head<m>());
      d.nodes.push_back(x.template tail<n>());
    }
    return d;
  }

  /// The right-hand side (-phi, 0) of a step of least norm back to the constraints.
  static Columns constraint_side(const Sys& system, const Kkt& kkt, const Path<Sys>& path, double& violation) {
    Columns b(path.size(), Kkt::Column::Zero());
    violation = 0;
    for (std::size_t k = 0; k < path.size(); ++k) {
      b[k].template head<m>() = -kkt.scale().template head<m>().cwiseProduct(constraint_values(system, path[k].arrow));
      const double largest = b[k].cwiseAbs().maxCoeff();
      violation = std::isfinite(largest) ? std::max(violation, largest) : largest;
      if (!std::isfinite(largest)) break;
    }
    return b;
  }
  static double square(const Columns& c) {
    double sum = 0;
    for (const auto& x : c) sum += x.squaredNorm();
    return sum;
  }

  static Direction without_multipliers(Direction d) {
    for (auto& l : d.multipliers) l.setZero();
    return d;
  }

  /// Damped Gauss-Newton steps of least norm until the path is admissible.
  bool restore(const BoundaryProblem<Sys>& problem, Kkt& kkt, Path<Sys>& path, BoundarySolution<Sys>& out) const {
    const Sys& system = problem.system;
    for (; out.iterations < options_.max_iterations; ++out.iterations) {
      kkt.evaluate(system, path, Kkt::Hessian::identity);
      if (!std::isfinite(kkt.residual_norm())) {
        fail(out, SolveStatus::not_finite, path);
        return false;
      }
      kkt.choose_scale();
      double violation = 0;
      const Columns b = constraint_side(system, kkt, path, violation);
      out.residual = violation;
      if (violation <= options_.feasibility && admissible(system, path)) return true;
      kkt.factor(0, 1e-10);
      const Direction direction = without_multipliers(unscaled(kkt, kkt.solve(b)));
      double fraction = std::min(1.0, options_.largest_displacement / reach(direction));
      bool advanced = false;
      for (int halving = 0; halving < 30 && !advanced; ++halving, fraction /= 2) {
        Path<Sys> trial = displaced(problem, path, direction.nodes, direction.multipliers, fraction);
        double unused = 0;
        if (square(constraint_side(system, kkt, trial, unused)) < (1 - 0.1 * fraction) * square(b)) {
          path = std::move(trial);
          advanced = true;
        }
      }
      if (!advanced) {
        fail(out, SolveStatus::stagnated, path);
        return false;
      }
    }
    fail(out, SolveStatus::not_converged, path);
    return false;
  }

  static bool least_squares_multipliers(const BoundaryProblem<Sys>& problem, Kkt& kkt, Path<Sys>& path) {
    for (auto& step : path) step.multipliers.setZero();
    kkt.evaluate(problem.system, path, Kkt::Hessian::identity);
    if (!std::isfinite(kkt.residual_norm())) return false;
    kkt.choose_scale();
    kkt.factor(0, 1e-8);
    const Direction z = unscaled(kkt, kkt.solve(negated(kkt.scaled_residual())));
    for (std::size_t k = 0; k < path.size(); ++k) path[k].multipliers = z.multipliers[k];
    return true;
  }

  /// One step of descent of the action along the manifold, by the least shift (of the right inertia) whose step stays
  /// in reach, comes back to the constraints and lowers the action. On entry `kkt` is evaluated at `path`; `shift` is
  /// the one that served last.
  bool descend(const BoundaryProblem<Sys>& problem, Kkt& kkt, Path<Sys>& path, double& shift,
               BoundarySolution<Sys>& out) const {
    const Sys& system = problem.system;
    ++out.iterations;
    kkt.choose_scale();
    out.residual = kkt.residual_norm();
    const Columns side = negated(kkt.scaled_residual());
    const double cost = action(system, path);
    constexpr double smallest = 1e-3;
    constexpr double largest = 1e8;
    shift = shift / 3 < smallest ? 0 : shift / 3;
    for (; shift < largest; shift = std::max(smallest, 3 * shift)) {
      if (!right_inertia(kkt, shift)) continue;
      const Direction direction = without_multipliers(unscaled(kkt, kkt.solve(side)));
      if (reach(direction) > options_.largest_displacement) continue;
      double slope = 0;
      for (std::size_t k = 0; k < path.size(); ++k) slope += kkt.cost_gradient()[k].dot(direction.nodes[k]);
      Path<Sys> trial = displaced(problem, path, direction.nodes, direction.multipliers, 1.0);
      if (pull_back(problem, kkt, trial) && action(system, trial) <= cost + 1e-4 * slope) {
        path = std::move(trial);
        return true;
      }
    }
    fail(out, SolveStatus::stagnated, path);
    return false;
  }

  /// Chord iterations with the factored matrix back to the constraints; false where they do not contract.
  bool pull_back(const BoundaryProblem<Sys>& problem, const Kkt& kkt, Path<Sys>& path) const {
    const Sys& system = problem.system;
    double violation = 0;
    Columns b = constraint_side(system, kkt, path, violation);
    for (int iteration = 0; iteration < 20; ++iteration) {
      if (!std::isfinite(violation)) return false;
      if (violation <= options_.feasibility) return admissible(system, path);
      const Direction d = without_multipliers(unscaled(kkt, kkt.solve(b)));
      path = displaced(problem, path, d.nodes, d.multipliers, 1.0);
      const double before = violation;
      b = constraint_side(system, kkt, path, violation);
      if (!(violation < 0.7 * before)) return false;
    }
    return false;
  }

  /// Newton on the full KKT system while it contracts; converged, or everything as it was.
  bool polish(const BoundaryProblem<Sys>& problem, Kkt& kkt, Path<Sys>& path, BoundarySolution<Sys>& out) const {
    const Sys& system = problem.system;
    Path<Sys> best = path;
    kkt.evaluate(system, best);
    kkt.choose_scale();
    double norm = kkt.residual_norm();
    int iterations = 0;
    for (bool contracts = true; contracts && std::isfinite(norm) && iterations < 30; ++iterations) {
      factor_plainly(kkt);
      const Direction d = unscaled(kkt, refined(kkt, negated(kkt.scaled_residual())));
      if (reach(d) > options_.largest_displacement) break;
      Path<Sys> trial = displaced(problem, best, d.nodes, d.multipliers, 1.0);
      kkt.evaluate(system, trial);
      const double next = kkt.residual_norm();
      contracts = next < 0.5 * norm && admissible(system, trial);
      if (contracts) {
        best = std::move(trial);
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
  void settle(const BoundaryProblem<Sys>& problem, Kkt& kkt, Path<Sys>& path, BoundarySolution<Sys>& out) const {
    const Sys& system = problem.system;
    kkt.evaluate(system, path);
    kkt.choose_scale();
    double norm = kkt.residual_norm();
    for (int failures = 0; failures < 8 && out.iterations < options_.max_iterations && norm > 1e-6;) {
      ++out.iterations;
      const double regularisation = std::pow(4.0, failures) * 0.1 * norm;
      double primal = regularisation;
      while (kkt.factor(primal, regularisation).negative != kkt.constraint_count() && primal < 1e6) primal *= 4;
      const Direction d = unscaled(kkt, kkt.solve(negated(kkt.scaled_residual())));
      Path<Sys> trial = displaced(problem, path, d.nodes, d.multipliers,
                                  std::min(1.0, options_.largest_displacement / std::max(1e-300, reach(d))));
      Kkt there = kkt;
      there.evaluate(system, trial);
      const double next = there.residual_norm();
      if (next < norm && admissible(system, trial)) {
        path = std::move(trial);
        kkt = std::move(there);
        norm = next;
        failures = 0;
      } else {
        ++failures;
      }
    }
    out.residual = norm;
    out.status = SolveStatus::stagnated;
    polish(problem, kkt, path, out);
  }

  /// Solves with the factored matrix and refines once.
  static Columns refined(const Kkt& kkt, const Columns& b) {
    Columns z = kkt.solve(b);
    Columns defect = kkt.multiply(z);
    for (std::size_t k = 0; k < b.size(); ++k) defect[k] = b[k] - defect[k];
    const Columns correction = kkt.solve(defect);
    for (std::size_t k = 0; k < b.size(); ++k) z[k] += correction[k];
    return z;
  }

  static constexpr double tiny_pivot = 1e-11;
  static constexpr double dual_shift = 1e-9;

  static void factor_plainly(Kkt& kkt) {
    if (kkt.factor(0, 0).smallest < tiny_pivot) kkt.factor(dual_shift, dual_shift);
  }

  /// Factors with the given shift; true when m N eigenvalues are negative, as at a minimum on the tangent space.
  static bool right_inertia(Kkt& kkt, double shift) {
    auto inertia = kkt.factor(shift, 0);
    if (inertia.smallest < tiny_pivot) inertia = kkt.factor(shift, dual_shift);
    return inertia.negative == kkt.constraint_count();
  }

  /// How far the node that moves most moves.
  static double reach(const Direction& direction) {
    double largest = 0;
    for (const auto& v : direction.nodes) largest = std::max(largest, v.norm());
    return largest;
  }

  static bool admissible(const Sys& system, const Path<Sys>& path) {
    if constexpr (HasBranch<Sys>) {
      return std::all_of(path.begin(), path.end(), [&](const Step<Sys>& s) { return system.admissible(s.arrow); });
    } else {
      return true;
    }
  }

  BoundaryOptions options_;
};

}  // namespace lagroid
