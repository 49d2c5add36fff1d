#pragma once
/// A boundary-value problem as a least-squares problem for Ceres: the squared, scaled residual of the KKT equations in
/// the arrows X_k = g_1 ... g_k and the multipliers.
///
///     const BoundaryProblem<Kepler> problem{Kepler{}, {{1, 0}, {-0.3, 0.8}}};
///     const BoundaryCeres<Kepler> ceres;
///     const auto found = ceres.solve(problem, geodesic_path(problem, 100), false);
///
/// Requirements and result are those of boundary_solver.hpp; Ceres and its headers must be there. Status:
/// `ill_conditioned` (a solution is near, but the normal equations are too ill-conditioned to reach it), `stagnated`,
/// `not_converged`, `not_finite`. It looks for stationary paths of any kind, whatever kind is wanted.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/derivatives/gradient_derivative.hpp>
#include <lagroid/solvers/boundary/boundary_newton.hpp>
#include <lagroid/solvers/ceres_solve.hpp>
#include <lagroid/solvers/newton/ceres_manifold.hpp>

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>
#include <deque>

namespace lagroid {

/// The KKT equations as a least-squares problem of zero residual: unknowns are the reaches X_k = g_1 ... g_k, points of
/// the source fibre over the first object (k = 1 ... N-1), and the multipliers. Levenberg-Marquardt on the squared
/// residual knows nothing of minima: any stationary point attracts it. Its normal equations square the condition
/// number, so that on very long paths it stalls above the tolerance: one Newton step distinguishes that from a problem
/// without a solution, and it is reported as `ill_conditioned`. Ceres' own verdict is not used: the status follows from
/// the residual, evaluated anew.
template <DiscreteSystem Sys> class BoundaryCeres final : public BoundarySolver<Sys> {
 public:
  using G = typename Sys::GroupoidType;
  static constexpr int n = Sys::dimension;
  static constexpr int m = Sys::constraints;
  static constexpr int phis = Sys::arrow_constraints;

  using BoundarySolver<Sys>::BoundarySolver;

 private:
  BoundarySolution<Sys> solve_from(const BoundaryProblem<Sys>& problem, Path<Sys> path,
                                   bool keep_multipliers) const override {
    BoundarySolution<Sys> out;
    const Sys& system = problem.system;
    BoundaryKkt<Sys> kkt;
    if (!keep_multipliers) {
      // The same start as Newton's: an admissible path with its least-squares multipliers.
      auto prepared = BoundaryNewton<Sys>(options_, stationary_kind_).prepare(problem, std::move(path));
      if (!prepared.converged()) return prepared;
      path = std::move(prepared.path);
      out.iterations = prepared.iterations;
    }
    kkt.evaluate(system, path);
    kkt.choose_scale();
    if (!std::isfinite(kkt.residual_norm())) {
      out.status = SolveStatus::not_finite;
      out.path = std::move(path);
      return out;
    }
    const ceres::Solver::Summary summary = minimise(problem, kkt.scale(), path);
    out.iterations += int(summary.iterations.size());
    out.path = std::move(path);
    kkt.evaluate(system, out.path);
    kkt.choose_scale();
    out.residual = kkt.residual_norm();
    if (out.residual <= options_.tolerance) {
      out.status = SolveStatus::converged;
      this->describe(system, kkt, out);
    } else if (!std::isfinite(out.residual) || could_not_begin(summary)) {
      out.status = SolveStatus::not_finite;
    } else if (summary.termination_type == ceres::NO_CONVERGENCE && still_falling(summary)) {
      out.status = SolveStatus::not_converged;
      out.message = fmt::format(
          "Ceres is still at residual {:.1e} after {} iterations; raise solver.max_iterations or use solver.method = "
          "\"newton\"",
          out.residual, summary.iterations.size());
    } else if (newton_contracts(problem, kkt, out.path)) {
      out.status = SolveStatus::ill_conditioned;
      out.message = fmt::format(
          "Ceres stalls at residual {:.1e}, above the tolerance {:.1e}, though a solution is near: its normal "
          "equations "
          "square the condition number, which {} steps make too large for double precision; use solver.method = "
          "\"newton\" or fewer steps (iterations: {})",
          out.residual, options_.tolerance, out.path.size(), summary.iterations.size());
    } else {
      out.status = SolveStatus::stagnated;
      out.message = fmt::format(
          "Ceres stalls at residual {:.1e}, a least of its squares that may be no solution; use solver.method = "
          "\"newton\"",
          out.residual);
    }
    return out;
  }

  using BoundarySolver<Sys>::options_;
  using BoundarySolver<Sys>::stationary_kind_;
  static constexpr int ambient = SourceFibreManifold<G>::ambient;

  /// Levenberg-Marquardt from `path`, which becomes what it found.
  ceres::Solver::Summary minimise(const BoundaryProblem<Sys>& problem, const Vector<double, n + m>& scale,
                                  Path<Sys>& path) const {
    const Sys& system = problem.system;
    const G& groupoid = system.groupoid;
    const std::size_t count = path.size();
    SourceFibreManifold<G> manifold(groupoid);
    std::vector<Vector<double, ambient>> reach(count + 1);
    std::vector<Vector<double, std::max(m, 1)>> multipliers(count);
    ArrowOf<G> product = groupoid.unit(groupoid.source(problem.boundary));
    reach[0] = groupoid.coordinates_of_arrow(product);
    for (std::size_t k = 0; k < count; ++k) {
      product = k + 1 == count ? problem.boundary : groupoid.project(groupoid.compose(product, path[k].arrow));
      reach[k + 1] = groupoid.coordinates_of_arrow(product);
      for (int a = 0; a < m; ++a) multipliers[k](a) = path[k].multipliers(a);
    }
    std::deque<NodeCost> costs;
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem ceres_problem(ownership);
    for (auto& x : reach) ceres_problem.AddParameterBlock(x.data(), ambient, &manifold);
    for (std::size_t k = 0; k < count; ++k) {
      const bool last = k + 1 == count;
      if (last && phis == 0) break;
      costs.emplace_back(system, manifold, scale, last);
      std::vector<double*> blocks{reach[k].data(), reach[k + 1].data()};
      if (!last) blocks.push_back(reach[k + 2].data());
      if (m > 0) blocks.push_back(multipliers[k].data());
      if (m > 0 && !last) blocks.push_back(multipliers[k + 1].data());
      ceres_problem.AddResidualBlock(&costs.back(), nullptr, blocks);
    }
    ceres_problem.SetParameterBlockConstant(reach.front().data());
    ceres_problem.SetParameterBlockConstant(reach.back().data());

    auto ceres_options = detail::to_round_off(options_.max_iterations);
    ceres_options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    ceres_options.parameter_tolerance = 1e-16;
    const auto summary = detail::solve_by_ceres(ceres_options, ceres_problem);
    for (std::size_t k = 0; k < count; ++k) {
      path[k].arrow = groupoid.project(
          groupoid.compose(groupoid.inverse(manifold.arrow(reach[k].data())), manifold.arrow(reach[k + 1].data())));
      for (int a = 0; a < m; ++a) path[k].multipliers(a) = multipliers[k](a);
    }
    return summary;
  }

  /// Whether not even the first point had derivatives.
  static bool could_not_begin(const ceres::Solver::Summary& summary) {
    return summary.termination_type == ceres::FAILURE && summary.iterations.empty();
  }

  /// Whether the last ten iterations lowered the cost by more than a stall does, or there were no ten.
  static bool still_falling(const ceres::Solver::Summary& summary) {
    constexpr std::size_t window = 10;
    const auto& iterations = summary.iterations;
    const std::size_t count = iterations.size();
    return count <= window || iterations.back().cost < 0.25 * iterations[count - 1 - window].cost;
  }

  /// Whether one Newton step from `path`, where `kkt` is evaluated, lowers the residual to a tenth.
  static bool newton_contracts(const BoundaryProblem<Sys>& problem, BoundaryKkt<Sys>& kkt, const Path<Sys>& path) {
    const double residual = kkt.residual_norm();
    kkt.factor(0, 0);
    typename BoundaryKkt<Sys>::Columns step;
    kkt.newton_side(step);
    kkt.solve_in_place(step);
    Variation<Sys> variation;
    kkt.unscale(step, variation);
    kkt.evaluate(problem.system, displaced(problem, path, variation, 1.0));
    return kkt.residual_norm() < 0.1 * residual;
  }

  /// phi(g_k) and, at inner nodes, C(q_k) and F+(g_k) - F-(g_{k+1}); parameters X_{k-1}, X_k [, X_{k+1}], then, where
  /// there are any, the multipliers of g_k [and g_{k+1}].
  class NodeCost final : public ceres::CostFunction {
   public:
    NodeCost(const Sys& system, const SourceFibreManifold<G>& manifold, const Vector<double, n + m>& scale, bool last)
        : system_(&system), manifold_(&manifold), scale_(scale), last_(last) {
      set_num_residuals(last ? phis : m + n);
      auto& sizes = *mutable_parameter_block_sizes();
      sizes.assign(last ? 2 : 3, ambient);
      if (m > 0) sizes.insert(sizes.end(), last ? 1 : 2, m);
    }

    bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
      const G& groupoid = system_->groupoid;
      const int lambdas = last_ ? 2 : 3;  // where the multipliers begin
      const auto multipliers = [&](int k) -> typename Sys::Multipliers {
        if constexpr (m == 0) return {};
        return Eigen::Map<const Vector<double, m>>(x[lambdas + k]);
      };
      const auto before = manifold_->arrow(x[0]);
      const auto node = manifold_->arrow(x[1]);
      const ArrowOf<G> g = groupoid.compose(groupoid.inverse(before), node);
      const typename Sys::Multipliers lambda = multipliers(0);
      const auto d = two_sided(*system_, g, lambda);
      Vector<double, m + n> r = joined<double, m, n>(d.constraint, d.target_gradient);
      TwoSidedOf<Sys> e;
      ArrowOf<G> after;
      ArrowOf<G> next;
      typename Sys::Multipliers next_lambda;
      if (!last_) {
        after = manifold_->arrow(x[2]);
        next = groupoid.compose(groupoid.inverse(node), after);
        next_lambda = multipliers(1);
        e = two_sided(*system_, next, next_lambda);
        for (int i = 0; i < n; ++i) r(m + i) += e.source_gradient(i);
      }
      const int rows = num_residuals();
      for (int i = 0; i < rows; ++i) {
        if (!std::isfinite(r(i))) return false;
        residuals[i] = scale_(i) * r(i);
      }
      if (jacobians == nullptr) return true;

      // Blocks by rows; entry by entry (docs/decisions/72_expressions_cost_their_square.md).
      const auto put = [&](int block, const Matrix<double, m + n, n>& derivative, const ArrowOf<G>& at) {
        if (jacobians[block] == nullptr) return;
        const auto coframe = manifold_->coframe(at);
        for (int i = 0; i < rows; ++i)
          for (int j = 0; j < ambient; ++j) {
            double sum = 0;
            for (int k = 0; k < n; ++k) sum += derivative(i, k) * coframe(k, j);
            jacobians[block][i * ambient + j] = scale_(i) * sum;
          }
      };
      Matrix<double, m + n, n> by_node;
      for (int j = 0; j < n; ++j) {
        for (int a = 0; a < m; ++a) by_node(a, j) = a < phis ? d.constraint_source(j, a) : 0;
        for (int i = 0; i < n; ++i) by_node(m + i, j) = d.mixed(j, i);
      }
      put(0, by_node, before);
      for (int j = 0; j < n; ++j)
        for (int a = 0; a < m; ++a) by_node(a, j) = d.constraint_target(a, j);
      if (!last_) {
        const Matrix<double, n, n> of_first = gradient_derivative(*system_, g, lambda, End::target);
        const Matrix<double, n, n> of_second = gradient_derivative(*system_, next, next_lambda, End::source);
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i) by_node(m + i, j) = of_first(i, j) + of_second(i, j);
      }
      put(1, by_node, node);
      if (!last_) {
        for (int j = 0; j < n; ++j) {
          for (int a = 0; a < m; ++a) by_node(a, j) = 0;
          for (int i = 0; i < n; ++i) by_node(m + i, j) = e.mixed(i, j);
        }
        put(2, by_node, after);
      }
      if constexpr (m > 0) {
        const auto put_multipliers = [&](int block, const auto& derivative) {
          if (jacobians[block] == nullptr) return;
          for (int i = 0; i < rows; ++i)
            for (int a = 0; a < m; ++a)
              jacobians[block][i * m + a] = i < m || last_ ? 0 : scale_(i) * derivative(i - m, a);
        };
        put_multipliers(lambdas, [&](int i, int a) { return a < phis ? d.constraint_target(a, i) : 0; });
        if (!last_) put_multipliers(lambdas + 1, e.constraint_source);
      }
      return true;
    }

   private:
    const Sys* system_;
    const SourceFibreManifold<G>* manifold_;
    Vector<double, n + m> scale_;
    bool last_;
  };
};

}  // namespace lagroid
