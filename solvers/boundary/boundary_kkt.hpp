#pragma once
/// The KKT matrix of a boundary-value problem, symmetric and block-tridiagonal along the path, with its elimination:
///
///     rows of node k:  (phi(g_k), C(q_k), F+(g_k) - F-(g_{k+1})),    columns:  (lambda_k, kappa_k, v_k).
///
/// The solvers of boundary values take from it residual, Newton steps and the inertia, which tells minima from saddles.
/// Requires arrows that compose; numbers that are not finite show in `residual_norm`.

#include <lagroid/core/derivatives/second_derivatives.hpp>
#include <lagroid/solvers/boundary/boundary_problem.hpp>
#include <lagroid/solvers/linear_algebra/symmetric_factor.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace lagroid {

/// Unknowns z_k = (lambda_k, kappa_k, v_k), k = 1 ... N: the multipliers of arrow k's own constraints phi, those of the
/// object constraints C at its target node q_k, and the displacement of that node; at the last node, which is fixed,
/// lambda alone. Equations: phi(g_k) = 0, C(q_k) = 0 and F+(g_k) - F-(g_{k+1}) = 0, the discrete constrained
/// Euler-Lagrange equations. (In a Path kappa_k belongs to arrow k + 1, of which q_k is the source.)
///
/// Everything is kept in scaled unknowns, z = scale * z', so that regularisation and round-off mean the same in each.
/// The elimination runs along the path with one Bunch-Kaufman factorisation a node: linear in N, without allocation
/// once the vectors have their size.
template <DiscreteSystem Sys> class BoundaryKkt {
 public:
  static constexpr int n = Sys::dimension;
  static constexpr int m = Sys::constraints;
  static constexpr int size = n + m;
  using Block = typename SymmetricFactor<size>::Square;
  using Coupling = Matrix<double, size, n>;
  using Column = Vector<double, size>;
  using Columns = std::vector<Column>;

  /// Which second derivatives stand in the (v, v) blocks.
  enum class Hessian {
    exact,
    identity,   ///< over the time step where there is one
    stiffness,  ///< of sum_k |v_k - v_{k-1}|^2 / 2, the same: steps of least norm are then smooth, whatever N
  };

  void evaluate(const Sys& system, const Path<Sys>& path, Hessian hessian = Hessian::exact) {
    const std::size_t count = path.size();
    diagonal_.assign(count, Block::Zero());
    coupling_.assign(count, Coupling::Zero());
    residual_.assign(count, Column::Zero());
    gradient_.assign(count, Vector<double, n>::Zero());
    const double metric = 1 / time_step(system);
    for (std::size_t k = 0; k < count; ++k) {
      if (hessian == Hessian::exact) {
        const auto d = second_derivatives(system, path[k].arrow, path[k].multipliers);
        add_equations(k, d, path[k].multipliers);
        coupling_[k].template bottomRows<n>() = d.mixed.transpose();
        diagonal_[k].template bottomRightCorner<n, n>() += d.target_hessian;
        if (k > 0) diagonal_[k - 1].template bottomRightCorner<n, n>() += d.source_hessian;
      } else {
        add_equations(k, two_sided(system, path[k].arrow, path[k].multipliers), path[k].multipliers);
        const Matrix<double, n, n> unit = metric * Matrix<double, n, n>::Identity();
        diagonal_[k].template bottomRightCorner<n, n>() += unit;
        if (hessian == Hessian::stiffness && k > 0) {
          diagonal_[k - 1].template bottomRightCorner<n, n>() += unit;
          coupling_[k].template bottomRows<n>() = -unit;
        }
      }
    }
    // The end node does not move: its unknowns are decoupled and kept at zero.
    residual_.back().template tail<fixed>().setZero();
    gradient_.back().setZero();
    diagonal_.back().template rightCols<fixed>().setZero();
    diagonal_.back().template bottomRows<fixed>().setZero();
    coupling_.back().template bottomRows<fixed>().setZero();
  }

  /// Chooses the scale from the blocks: symmetric equilibration of their entrywise maximum over the path.
  void choose_scale() {
    Block largest = Block::Zero();
    for (const Block& b : diagonal_) largest = largest.cwiseMax(b.cwiseAbs());
    scale_.setOnes();
    for (int sweep = 0; sweep < 10; ++sweep)
      for (int i = 0; i < size; ++i) {
        const double entry = (largest.row(i).transpose().cwiseProduct(scale_)).maxCoeff() * scale_(i);
        if (entry > 0) scale_(i) /= std::sqrt(entry);
      }
    scale_ = scale_.unaryExpr([](double x) { return std::exp2(std::round(std::log2(x))); });
  }

  /// What a factorisation shows of the matrix.
  struct Inertia {
    long negative = 0;
    double smallest = std::numeric_limits<double>::infinity();  ///< |pivot|, scaled
  };

  /// Factors with `primal` added to the (v, v) and `dual` subtracted from the multipliers' diagonal, and `stiffness`
  /// times the matrix of sum_k |v_k - v_{k-1}|^2 / 4 added to the (v, v) part (all scaled).
  Inertia factor(double primal, double dual, double stiffness = 0) {
    const std::size_t count = diagonal_.size();
    factors_.resize(count);
    eliminated_.resize(count);
    Inertia inertia;
    for (std::size_t k = 0; k < count; ++k) {
      Block s = scale_.asDiagonal() * diagonal_[k] * scale_.asDiagonal();
      s.diagonal().template head<m>().array() -= dual;
      s.diagonal().template tail<n>().array() += primal + stiffness;
      if (k + 1 == count) s.template bottomRightCorner<fixed, fixed>().setIdentity();
      if (k > 0) {
        Coupling c = scale_.asDiagonal() * coupling_[k] * scale_.template tail<n>().asDiagonal();
        if (k + 1 < count) c.template bottomRows<n>().diagonal().array() -= 0.5 * stiffness;
        Block right = Block::Zero();
        right.template bottomRows<n>() = c.transpose();
        eliminated_[k - 1] = factors_[k - 1].subtract_from(s, right);
      }
      factors_[k].compute(s);
      inertia.negative += factors_[k].negative();
      inertia.smallest = std::min(inertia.smallest, factors_[k].smallest());
    }
    return inertia;
  }

  /// Solves the factored system in place; right-hand side and solution in scaled unknowns.
  void solve_in_place(Columns& b) const {
    const std::size_t count = b.size();
    for (std::size_t k = 1; k < count; ++k) b[k] -= eliminated_[k - 1].transpose() * b[k - 1];
    for (std::size_t k = count; k-- > 0;) {
      b[k] = factors_[k].solve(b[k]);
      if (k + 1 < count) b[k] -= eliminated_[k] * b[k + 1];
    }
  }
  Columns solve(Columns b) const {
    solve_in_place(b);
    return b;
  }

  /// The matrix (without regularisation) times a vector, in scaled unknowns.
  Columns multiply(const Columns& z) const {
    Columns out(z.size(), Column::Zero());
    add_product(1, z, out);
    return out;
  }
  /// out += factor * (the matrix times z).
  void add_product(double factor, const Columns& z, Columns& out) const {
    const std::size_t count = z.size();
    const auto unscaled = [&](std::size_t k) -> Column { return scale_.cwiseProduct(z[k]); };
    for (std::size_t k = 0; k < count; ++k) {
      Column sum = diagonal_[k] * unscaled(k);
      if (k > 0) sum += coupling_[k] * unscaled(k - 1).template tail<n>();
      if (k + 1 < count) sum.template tail<n>() += coupling_[k + 1].transpose() * unscaled(k + 1);
      out[k] += factor * scale_.cwiseProduct(sum);
    }
    out.back().template tail<fixed>() += factor * z.back().template tail<fixed>();
  }

  /// The equations' residual in scaled form, negated: the right-hand side of a Newton step.
  void newton_side(Columns& out) const {
    out.resize(residual_.size());
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = -scale_.cwiseProduct(residual_[k]);
  }
  /// The right-hand side of a step back to the constraints at `path`: their scaled values, negated. Returns the
  /// largest, or whatever is not finite.
  double constraint_side(const Sys& system, const Path<Sys>& path, Columns& out) const {
    out.assign(path.size(), Column::Zero());
    double violation = 0;
    for (std::size_t k = 0; k < path.size(); ++k) {
      out[k].template head<m>() = -scale_.template head<m>().cwiseProduct(constraint_values(system, path[k].arrow));
      if (k + 1 == path.size()) out[k].template tail<fixed>().setZero();
      const double largest = out[k].cwiseAbs().maxCoeff();
      if (!out[k].allFinite()) return std::numeric_limits<double>::quiet_NaN();
      violation = std::max(violation, largest);
    }
    return violation;
  }
  /// The largest scaled residual; a NaN where anything is not finite.
  double residual_norm() const {
    double norm = 0;
    for (const Column& c : residual_) {
      if (!c.allFinite()) return std::numeric_limits<double>::quiet_NaN();
      norm = std::max(norm, scale_.cwiseProduct(c).cwiseAbs().maxCoeff());
    }
    return norm;
  }

  /// Scaled unknowns as a variation of the path.
  void unscale(const Columns& z, Variation<Sys>& out) const {
    const std::size_t count = z.size();
    out.nodes.resize(count);
    out.multipliers.resize(count);
    if constexpr (m > 0) out.multipliers.front().setZero();
    for (std::size_t k = 0; k < count; ++k) {
      const Column x = scale_.cwiseProduct(z[k]);
      out.nodes[k] = x.template tail<n>();
      out.multipliers[k].template head<phis>() = x.template head<phis>();
      if (k + 1 < count) out.multipliers[k + 1].template tail<m - phis>() = x.template segment<m - phis>(phis);
    }
  }

  const std::vector<Vector<double, n>>& cost_gradient() const { return gradient_; }
  const Columns& residual() const { return residual_; }
  const Column& scale() const { return scale_; }
  long constraint_count() const { return long(diagonal_.size()) * m - (m - phis); }

  /// The second-order type of a stationary point: the inertia of the matrix with null directions counted as positive,
  /// and a search for null vectors by inverse iteration. `*this` must be evaluated at the point, with exact Hessians;
  /// it is afterwards evaluated there without.
  Classification classify(const Sys& system, const Path<Sys>& path) {
    // Genuine eigenvalues of a well-posed problem shrink like N^-2 in scaled unknowns.
    const double count = double(path.size());
    const double null = std::max(1e-4 / (count * count), 1e-12);
    Classification kind;
    // A null vector has parts in both unknowns: shift the Hessian block by far the more, so that it counts as positive.
    kind.negative_directions = factor(null, 1e-3 * null).negative - constraint_count();
    kind.is_minimum = kind.negative_directions == 0;
    for (const Columns& z : null_vectors(null, 6)) {
      double primal = 0;
      for (const Column& c : z) primal += c.template tail<n>().squaredNorm();
      if (primal > 1e-3) kind.isolated = false;
    }
    if constexpr (m == 0) return kind;
    // With the identity for a Hessian the null vectors are the multipliers that annihilate the constraint gradients.
    evaluate(system, path, Hessian::identity);
    factor(0, null);
    kind.normal = null_vectors(null, 1).empty();
    return kind;
  }

 private:
  /// Up to `most` orthonormal vectors that the matrix sends below `threshold`, by inverse iteration with its factors.
  std::vector<Columns> null_vectors(double threshold, int most) const {
    const auto dot = [](const Columns& a, const Columns& b) {
      double sum = 0;
      for (std::size_t k = 0; k < a.size(); ++k) sum += a[k].dot(b[k]);
      return sum;
    };
    std::mt19937_64 generator(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Columns> found;
    while (int(found.size()) < most) {
      Columns z(diagonal_.size());
      for (Column& c : z)
        for (int i = 0; i < size; ++i) c(i) = uniform(generator);
      z.back().template tail<fixed>().setZero();
      for (int iteration = 0; iteration < 5; ++iteration) {
        solve_in_place(z);
        for (const Columns& f : found) {
          const double overlap = dot(z, f);
          for (std::size_t k = 0; k < z.size(); ++k) z[k] -= overlap * f[k];
        }
        const double norm = std::sqrt(dot(z, z));
        for (Column& c : z) c /= norm;
      }
      const Columns image = multiply(z);
      if (!(std::sqrt(dot(image, image)) < threshold)) break;
      found.push_back(std::move(z));
    }
    return found;
  }

  static constexpr int phis = Sys::arrow_constraints;
  static constexpr int fixed = size - phis;  // unknowns of a node that cannot move

  /// The equations of arrow k and their derivatives in the multipliers.
  void add_equations(std::size_t k, const TwoSidedOf<Sys>& d, const typename Sys::Multipliers& lambda) {
    residual_[k].template head<m>() = d.constraint;
    diagonal_[k].template topRightCorner<m, n>() = d.constraint_target;
    diagonal_[k].template bottomLeftCorner<n, m>() = d.constraint_target.transpose();
    coupling_[k].template topRows<phis>() = d.constraint_source.template leftCols<phis>().transpose();
    residual_[k].template tail<n>() += d.target_gradient;
    gradient_[k] +=
        d.target_gradient - d.constraint_target.template topRows<phis>().transpose() * lambda.template head<phis>();
    if (k > 0) {
      residual_[k - 1].template tail<n>() += d.source_gradient;
      gradient_[k - 1] += d.source_gradient - d.constraint_source * lambda;
    }
  }

  std::vector<Block> diagonal_;     // k: rows and columns z_k
  std::vector<Coupling> coupling_;  // k: rows z_k, columns v_{k-1}
  Columns residual_;
  std::vector<Vector<double, n>> gradient_;  // of the cost alone
  Column scale_ = Column::Ones();
  std::vector<Block> eliminated_;  // k: the inverse of the k-th pivot block times its coupling to z_{k+1}
  std::vector<SymmetricFactor<size>> factors_;
};

}  // namespace lagroid
