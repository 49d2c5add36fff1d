#pragma once
/// Boundary-value problems through Ceres.

#include <lagroid/solvers/boundary_newton.hpp>
#include <lagroid/solvers/ceres_manifold.hpp>

#include <ceres/ceres.h>

#include <deque>

namespace lagroid {

/// d/dv_j of the gradient df/du_i of f = L + <lambda, phi> when the arrow is first displaced by v, then by u, both at
/// the same end: f(g tau(v) tau(u)) or f(tau(u)^{-1} tau(v)^{-1} g). The symmetric Hessian of `one_sided_hessian` plus
/// half the gradient on the bracket [v, u]; the exact derivative of F+ or -F- along the fibre, away from solutions too.
template <DiscreteSystem Sys>
Matrix<double, Sys::dimension, Sys::dimension> gradient_derivative(const Sys& system,
                                                                   const ArrowOf<typename Sys::GroupoidType>& g,
                                                                   const typename Sys::Multipliers& lambda, End end) {
  using M = MixedOf<Sys>;
  constexpr int n = Sys::dimension;
  const auto& groupoid = system.groupoid;
  Vector<M, n> u = Vector<M, n>::Constant(M(0));
  Vector<M, n> v = u;
  for (int i = 0; i < n; ++i) {
    u(i).set_left(i, 1);
    v(i).set_right(i, 1);
  }
  const Vector<M, n> zero = Vector<M, n>::Constant(M(0));
  const auto start = groupoid.template cast<M>(g);
  const auto once = end == End::target ? groupoid.translate(zero, start, v) : groupoid.translate(v, start, zero);
  const auto twice = end == End::target ? groupoid.translate(zero, once, u) : groupoid.translate(u, once, zero);
  return detail::augmented_lagrangian<M>(system, twice, lambda).mixed();
}

/// The KKT equations as a least-squares problem of zero residual: unknowns are the reaches X_k = g_1 ... g_k, points of
/// the alpha-fibre over the first object (k = 1 ... N-1), and the multipliers. Levenberg-Marquardt on the squared
/// residual knows nothing of minima: any stationary point attracts it. The normal equations square the condition
/// number, so very long paths stagnate, and are then reported as such.
template <DiscreteSystem Sys> class BoundaryCeres {
 public:
  using G = typename Sys::GroupoidType;
  static constexpr int n = Sys::dimension;
  static constexpr int m = Sys::constraints;

  explicit BoundaryCeres(BoundaryOptions options = {}) : options_(options) {}

  BoundarySolution<Sys> solve(const BoundaryProblem<Sys>& problem, Path<Sys> path, bool keep_multipliers) const {
    BoundarySolution<Sys> out;
    const Sys& system = problem.system;
    const G& groupoid = system.groupoid;
    BoundaryKkt<Sys> kkt;
    if (!keep_multipliers) {
      // The same start as Newton's: an admissible path with its least-squares multipliers.
      const auto prepared = BoundaryNewton<Sys>(options_).prepare(problem, path);
      if (!prepared.converged()) return prepared;
      path = prepared.path;
      out.iterations = prepared.iterations;
    }
    kkt.evaluate(system, path);
    kkt.choose_scale();
    if (!std::isfinite(kkt.residual_norm())) {
      out.status = SolveStatus::not_finite;
      out.path = std::move(path);
      return out;
    }

    const std::size_t count = path.size();
    AlphaFibreManifold<G> manifold(groupoid);
    std::vector<Vector<double, ambient>> reach(count + 1);
    std::vector<Vector<double, m>> multipliers(count);
    ArrowOf<G> product = groupoid.unit(groupoid.source(problem.boundary));
    reach[0] = groupoid.coordinates_of_arrow(product);
    for (std::size_t k = 0; k < count; ++k) {
      product = k + 1 == count ? problem.boundary : groupoid.project(groupoid.compose(product, path[k].arrow));
      reach[k + 1] = groupoid.coordinates_of_arrow(product);
      multipliers[k] = path[k].multipliers;
    }
    std::deque<NodeCost> costs;
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem ceres_problem(ownership);
    for (auto& x : reach) ceres_problem.AddParameterBlock(x.data(), ambient, &manifold);
    for (std::size_t k = 0; k < count; ++k) {
      const bool last = k + 1 == count;
      costs.emplace_back(system, manifold, kkt.scale(), last);
      std::vector<double*> blocks{reach[k].data(), reach[k + 1].data(), multipliers[k].data()};
      if (!last) {
        blocks.push_back(reach[k + 2].data());
        blocks.push_back(multipliers[k + 1].data());
      }
      ceres_problem.AddResidualBlock(&costs.back(), nullptr, blocks);
    }
    ceres_problem.SetParameterBlockConstant(reach.front().data());
    ceres_problem.SetParameterBlockConstant(reach.back().data());

    ceres::Solver::Options ceres_options;
    ceres_options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    ceres_options.max_num_iterations = options_.max_iterations;
    ceres_options.function_tolerance = 0;
    ceres_options.gradient_tolerance = 0;
    ceres_options.parameter_tolerance = 1e-16;
    ceres_options.logging_type = ceres::SILENT;
    ceres_options.num_threads = 1;
    ceres::Solver::Summary summary;
    ceres::Solve(ceres_options, &ceres_problem, &summary);
    out.iterations += int(summary.iterations.size());

    for (std::size_t k = 0; k < count; ++k) {
      path[k].arrow = groupoid.project(
          groupoid.compose(groupoid.inverse(manifold.arrow(reach[k].data())), manifold.arrow(reach[k + 1].data())));
      path[k].multipliers = multipliers[k];
    }
    kkt.evaluate(system, path);
    kkt.choose_scale();
    out.residual = kkt.residual_norm();
    out.path = std::move(path);
    if (!std::isfinite(out.residual)) {
      out.status = SolveStatus::not_finite;
    } else if (out.residual > options_.tolerance) {
      out.status = SolveStatus::stagnated;
    } else {
      out.status = SolveStatus::converged;
      out.cost = action(system, out.path);
      out.kind = kkt.classify(system, out.path);
    }
    return out;
  }

 private:
  static constexpr int ambient = AlphaFibreManifold<G>::ambient;

  /// phi(g_k) and, at inner nodes, F+(g_k) - F-(g_{k+1}); parameters X_{k-1}, X_k, lambda_k [, X_{k+1}, lambda_{k+1}].
  class NodeCost final : public ceres::CostFunction {
   public:
    NodeCost(const Sys& system, const AlphaFibreManifold<G>& manifold, const Vector<double, n + m>& scale, bool last)
        : system_(&system), manifold_(&manifold), scale_(scale), last_(last) {
      set_num_residuals(last ? m : m + n);
      *mutable_parameter_block_sizes() =
          last ? std::vector<int>{ambient, ambient, m} : std::vector<int>{ambient, ambient, m, ambient, m};
    }

    bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
      const G& groupoid = system_->groupoid;
      const auto before = manifold_->arrow(x[0]);
      const auto node = manifold_->arrow(x[1]);
      const ArrowOf<G> g = groupoid.compose(groupoid.inverse(before), node);
      const typename Sys::Multipliers lambda = Eigen::Map<const typename Sys::Multipliers>(x[2]);
      const auto d = two_sided(*system_, g, lambda);
      const auto c_scale = scale_.template head<m>();
      const auto f_scale = scale_.template tail<n>();
      Eigen::Map<Vector<double, m>> c(residuals);
      c = d.constraint.cwiseProduct(c_scale);
      if (!c.allFinite()) return false;
      TwoSidedOf<Sys> e;
      ArrowOf<G> after;
      ArrowOf<G> next;
      typename Sys::Multipliers next_lambda;
      if (!last_) {
        after = manifold_->arrow(x[3]);
        next = groupoid.compose(groupoid.inverse(node), after);
        next_lambda = Eigen::Map<const typename Sys::Multipliers>(x[4]);
        e = two_sided(*system_, next, next_lambda);
        Eigen::Map<Vector<double, n>> f(residuals + m);
        f = (d.target_gradient + e.source_gradient).cwiseProduct(f_scale);
        if (!f.allFinite()) return false;
      }
      if (jacobians == nullptr) return true;
      const auto put = [&](int block, const Matrix<double, m, n>& upper, const Matrix<double, n, n>& lower,
                           const ArrowOf<G>& at) {
        if (jacobians[block] == nullptr) return;
        const auto coframe = manifold_->coframe(at);
        using J = Eigen::Matrix<double, Eigen::Dynamic, ambient, Eigen::RowMajor>;
        Eigen::Map<J> j(jacobians[block], num_residuals(), ambient);
        j.topRows(m) = c_scale.asDiagonal() * upper * coframe;
        if (!last_) j.bottomRows(n) = f_scale.asDiagonal() * lower * coframe;
      };
      const auto put_multiplier = [&](int block, const Matrix<double, n, m>& lower) {
        if (jacobians[block] == nullptr) return;
        using J = Eigen::Matrix<double, Eigen::Dynamic, m, m == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
        Eigen::Map<J> j(jacobians[block], num_residuals(), m);
        j.setZero();
        if (!last_) j.bottomRows(n) = f_scale.asDiagonal() * lower;
      };
      Matrix<double, n, n> stiffness = Matrix<double, n, n>::Zero();
      if (!last_)
        stiffness = gradient_derivative(*system_, g, lambda, End::target) +
                    gradient_derivative(*system_, next, next_lambda, End::source);
      put(0, d.constraint_source.transpose(), d.mixed.transpose(), before);
      put(1, d.constraint_target, stiffness, node);
      put_multiplier(2, d.constraint_target.transpose());
      if (!last_) {
        put(3, Matrix<double, m, n>::Zero(), e.mixed, after);
        put_multiplier(4, e.constraint_source);
      }
      return true;
    }

   private:
    const Sys* system_;
    const AlphaFibreManifold<G>* manifold_;
    Vector<double, n + m> scale_;
    bool last_;
  };

  BoundaryOptions options_;
};

}  // namespace lagroid
