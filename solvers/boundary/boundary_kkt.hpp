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
    diagonal_.assign(count, zero<Block>());
    coupling_.assign(count, zero<Coupling>());
    residual_.assign(count, zero<Column>());
    gradient_.assign(count, zero<Vector<double, n>>());
    const double metric = 1 / time_step(system);
    for (std::size_t k = 0; k < count; ++k) {
      if (hessian == Hessian::exact) {
        const auto d = second_derivatives(system, path[k].arrow, path[k].multipliers);
        add_equations(k, d, path[k].multipliers);
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < n; ++j) {
            coupling_[k](m + i, j) = d.mixed(j, i);
            diagonal_[k](m + i, m + j) += d.target_hessian(i, j);
            if (k > 0) diagonal_[k - 1](m + i, m + j) += d.source_hessian(i, j);
          }
      } else {
        add_equations(k, two_sided(system, path[k].arrow, path[k].multipliers), path[k].multipliers);
        for (int i = 0; i < n; ++i) {
          diagonal_[k](m + i, m + i) += metric;
          if (hessian == Hessian::stiffness && k > 0) {
            diagonal_[k - 1](m + i, m + i) += metric;
            coupling_[k](m + i, i) = -metric;
          }
        }
      }
    }
    // The end node does not move: its unknowns are decoupled and kept at zero.
    gradient_.back() = zero<Vector<double, n>>();
    for (int i = 0; i < size; ++i) {
      if (i >= phis) residual_.back()(i) = 0;
      for (int j = 0; j < size; ++j)
        if (i >= phis || j >= phis) diagonal_.back()(i, j) = 0;
      for (int j = 0; j < n; ++j)
        if (i >= phis) coupling_.back()(i, j) = 0;
    }
  }

  /// Chooses the scale from the blocks: symmetric equilibration of their entrywise maximum over the path.
  void choose_scale() {
    Block largest = zero<Block>();
    for (const Block& b : diagonal_)
      for (int i = 0; i < size * size; ++i) largest.data()[i] = std::max(largest.data()[i], std::abs(b.data()[i]));
    scale_ = ones();
    for (int sweep = 0; sweep < 10; ++sweep)
      for (int i = 0; i < size; ++i) {
        double entry = 0;
        for (int j = 0; j < size; ++j) entry = std::max(entry, largest(i, j) * scale_(j));
        entry *= scale_(i);
        if (entry > 0) scale_(i) /= std::sqrt(entry);
      }
    for (double& x : scale_) x = std::exp2(std::round(std::log2(x)));
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
      Block s;
      for (int i = 0; i < size; ++i) {
        for (int j = 0; j < size; ++j) s(i, j) = scale_(i) * diagonal_[k](i, j) * scale_(j);
        s(i, i) += i < m ? -dual : primal + stiffness;
      }
      if (k + 1 == count)
        for (int i = phis; i < size; ++i)
          for (int j = phis; j < size; ++j) s(i, j) = i == j ? 1 : 0;
      if (k > 0) {
        Block right = zero<Block>();
        for (int i = 0; i < n; ++i) {
          for (int j = 0; j < size; ++j) right(m + i, j) = scale_(j) * coupling_[k](j, i) * scale_(m + i);
          if (k + 1 < count) right(m + i, m + i) -= 0.5 * stiffness;
        }
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
    Columns out(z.size(), zero<Column>());
    add_product(1, z, out);
    return out;
  }
  /// out += factor * (the matrix times z).
  void add_product(double factor, const Columns& z, Columns& out) const {
    const std::size_t count = z.size();
    for (std::size_t k = 0; k < count; ++k)
      for (int i = 0; i < size; ++i) {
        double sum = 0;
        for (int j = 0; j < size; ++j) sum += diagonal_[k](i, j) * (scale_(j) * z[k](j));
        if (k > 0)
          for (int j = 0; j < n; ++j) sum += coupling_[k](i, j) * (scale_(m + j) * z[k - 1](m + j));
        if (k + 1 < count && i >= m)
          for (int j = 0; j < size; ++j) sum += coupling_[k + 1](j, i - m) * (scale_(j) * z[k + 1](j));
        out[k](i) += factor * (scale_(i) * sum);
      }
    for (int i = phis; i < size; ++i) out.back()(i) += factor * z.back()(i);
  }

  /// The equations' residual in scaled form, negated: the right-hand side of a Newton step.
  void newton_side(Columns& out) const {
    out.resize(residual_.size());
    for (std::size_t k = 0; k < out.size(); ++k)
      for (int i = 0; i < size; ++i) out[k](i) = -(scale_(i) * residual_[k](i));
  }
  /// The right-hand side of a step back to the constraints at `path`: their scaled values, negated. Returns the
  /// largest, or whatever is not finite.
  double constraint_side(const Sys& system, const Path<Sys>& path, Columns& out) const {
    out.assign(path.size(), zero<Column>());
    double violation = 0;
    for (std::size_t k = 0; k < path.size(); ++k) {
      const Vector<double, m> values = constraint_values(system, path[k].arrow);
      for (int i = 0; i < (k + 1 == path.size() ? phis : m); ++i) {
        out[k](i) = -(scale_(i) * values(i));
        if (!std::isfinite(out[k](i))) return std::numeric_limits<double>::quiet_NaN();
        violation = std::max(violation, std::abs(out[k](i)));
      }
    }
    return violation;
  }
  /// The largest scaled residual; a NaN where anything is not finite.
  double residual_norm() const {
    double norm = 0;
    for (const Column& c : residual_)
      for (int i = 0; i < size; ++i) {
        if (!std::isfinite(c(i))) return std::numeric_limits<double>::quiet_NaN();
        norm = std::max(norm, std::abs(scale_(i) * c(i)));
      }
    return norm;
  }

  /// Scaled unknowns as a variation of the path.
  void unscale(const Columns& z, Variation<Sys>& out) const {
    const std::size_t count = z.size();
    out.nodes.resize(count);
    out.multipliers.resize(count);
    for (int i = 0; i < m; ++i) out.multipliers.front()(i) = 0;
    for (std::size_t k = 0; k < count; ++k) {
      for (int i = 0; i < n; ++i) out.nodes[k](i) = scale_(m + i) * z[k](m + i);
      for (int i = 0; i < phis; ++i) out.multipliers[k](i) = scale_(i) * z[k](i);
      if (k + 1 < count)
        for (int i = phis; i < m; ++i) out.multipliers[k + 1](i) = scale_(i) * z[k](i);
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
      for (const Column& c : z)
        for (int i = m; i < size; ++i) primal += c(i) * c(i);
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
      for (std::size_t k = 0; k < a.size(); ++k)
        for (int i = 0; i < size; ++i) sum += a[k](i) * b[k](i);
      return sum;
    };
    std::mt19937_64 generator(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Columns> found;
    while (int(found.size()) < most) {
      Columns z(diagonal_.size());
      for (Column& c : z)
        for (int i = 0; i < size; ++i) c(i) = uniform(generator);
      for (int i = phis; i < size; ++i) z.back()(i) = 0;
      for (int iteration = 0; iteration < 5; ++iteration) {
        solve_in_place(z);
        for (const Columns& f : found) {
          const double overlap = dot(z, f);
          for (std::size_t k = 0; k < z.size(); ++k)
            for (int i = 0; i < size; ++i) z[k](i) -= overlap * f[k](i);
        }
        const double norm = std::sqrt(dot(z, z));
        for (Column& c : z)
          for (double& x : c) x /= norm;
      }
      const Columns image = multiply(z);
      if (!(std::sqrt(dot(image, image)) < threshold)) break;
      found.push_back(std::move(z));
    }
    return found;
  }

  static constexpr int phis = Sys::arrow_constraints;  // of a node that cannot move, the only unknowns: the first

  // Entry by entry, here and above: as expressions of Eigen's these took every file with boundary values of one size
  // more longer than its derivatives did (docs/decisions/72_expressions_cost_their_square.md).
  template <class M> static M zero() {
    M out;
    for (Eigen::Index i = 0; i < out.size(); ++i) out.data()[i] = 0;
    return out;
  }
  static Column ones() {
    Column out;
    for (double& x : out) x = 1;
    return out;
  }

  /// The equations of arrow k and their derivatives in the multipliers.
  void add_equations(std::size_t k, const TwoSidedOf<Sys>& d, const typename Sys::Multipliers& lambda) {
    for (int a = 0; a < m; ++a) {
      residual_[k](a) = d.constraint(a);
      for (int i = 0; i < n; ++i) diagonal_[k](a, m + i) = diagonal_[k](m + i, a) = d.constraint_target(a, i);
    }
    for (int a = 0; a < phis; ++a)
      for (int i = 0; i < n; ++i) coupling_[k](a, i) = d.constraint_source(i, a);
    for (int i = 0; i < n; ++i) {
      residual_[k](m + i) += d.target_gradient(i);
      double by_constraints = 0;
      for (int a = 0; a < phis; ++a) by_constraints += d.constraint_target(a, i) * lambda(a);
      gradient_[k](i) += d.target_gradient(i) - by_constraints;
    }
    if (k == 0) return;
    for (int i = 0; i < n; ++i) {
      residual_[k - 1](m + i) += d.source_gradient(i);
      double by_constraints = 0;
      for (int a = 0; a < m; ++a) by_constraints += d.constraint_source(i, a) * lambda(a);
      gradient_[k - 1](i) += d.source_gradient(i) - by_constraints;
    }
  }

  std::vector<Block> diagonal_;     // k: rows and columns z_k
  std::vector<Coupling> coupling_;  // k: rows z_k, columns v_{k-1}
  Columns residual_;
  std::vector<Vector<double, n>> gradient_;  // of the cost alone
  Column scale_ = ones();
  std::vector<Block> eliminated_;  // k: the inverse of the k-th pivot block times its coupling to z_{k+1}
  std::vector<SymmetricFactor<size>> factors_;
};

}  // namespace lagroid
