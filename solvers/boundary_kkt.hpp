#pragma once
/// The KKT system of a boundary-value problem, as a symmetric block-tridiagonal matrix along the path.

#include <lagroid/solvers/boundary_problem.hpp>

#include <Eigen/Eigenvalues>

#include <limits>
#include <random>
#include <vector>

namespace lagroid {

/// Unknowns z_k = (lambda_k, v_k), k = 1 ... N (v_N = 0): the multiplier of arrow k and the displacement of its target
/// node. Equations: phi(g_k) = 0 and F+(g_k) - F-(g_{k+1}) = 0, the discrete constrained Euler-Lagrange equations.
///
/// Everything is kept in scaled unknowns, z = scale * z', so that regularisation and round-off mean the same in each.
template <DiscreteSystem Sys> class BoundaryKkt {
  static_assert(Sys::object_constraints == 0, "boundary-value problems take arrow constraints only");
  static_assert(HasTimeStep<Sys>, "the metric of least-norm steps needs the time step h");

 public:
  static constexpr int n = Sys::dimension;
  static constexpr int m = Sys::constraints;
  static constexpr int size = n + m;
  using Block = Matrix<double, size, size>;
  using Coupling = Matrix<double, size, n>;
  using Column = Vector<double, size>;
  using Columns = std::vector<Column>;

  /// Which second derivatives stand in the (v, v) blocks.
  enum class Hessian {
    exact,
    identity  ///< the system then yields least-squares multipliers
  };

  void evaluate(const Sys& system, const Path<Sys>& path, Hessian hessian = Hessian::exact) {
    const std::size_t count = path.size();
    diagonal_.assign(count, Block::Zero());
    coupling_.assign(count, Coupling::Zero());
    residual_.assign(count, Column::Zero());
    gradient_.assign(count, Vector<double, n>::Zero());
    for (std::size_t k = 0; k < count; ++k) {
      const auto& [arrow, lambda] = path[k];
      const auto d = two_sided(system, arrow, lambda);
      residual_[k].template head<m>() = d.constraint;
      diagonal_[k].template topRightCorner<m, n>() = d.constraint_target;
      diagonal_[k].template bottomLeftCorner<n, m>() = d.constraint_target.transpose();
      coupling_[k].template topRows<m>() = d.constraint_source.transpose();
      residual_[k].template tail<n>() += d.target_gradient;
      gradient_[k] += d.target_gradient - d.constraint_target.transpose() * lambda;
      if (k > 0) {
        residual_[k - 1].template tail<n>() += d.source_gradient;
        gradient_[k - 1] += d.source_gradient - d.constraint_source * lambda;
      }
      if (hessian == Hessian::exact) {
        coupling_[k].template bottomRows<n>() = d.mixed.transpose();
        diagonal_[k].template bottomRightCorner<n, n>() += one_sided_hessian(system, arrow, lambda, End::target);
        if (k > 0)
          diagonal_[k - 1].template bottomRightCorner<n, n>() += one_sided_hessian(system, arrow, lambda, End::source);
      } else {
        diagonal_[k].template bottomRightCorner<n, n>() += Matrix<double, n, n>::Identity() / system.h;
      }
    }
    // The end node does not move: its unknown is decoupled and kept at zero.
    residual_.back().template tail<n>().setZero();
    gradient_.back().setZero();
    diagonal_.back().template rightCols<n>().setZero();
    diagonal_.back().template bottomRows<n>().setZero();
    coupling_.back().template bottomRows<n>().setZero();
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

  /// What a factorisation says of the matrix.
  struct Inertia {
    long negative = 0;
    double smallest = std::numeric_limits<double>::infinity();  ///< |eigenvalue| of a pivot block, scaled
  };

  /// Factors with `primal` added to the (v, v) and `dual` subtracted from the (lambda, lambda) diagonal (scaled).
  Inertia factor(double primal, double dual) {
    const std::size_t count = diagonal_.size();
    vectors_.resize(count);
    inverse_values_.resize(count);
    Inertia inertia;
    const auto scaled_coupling = [&](std::size_t k) -> Coupling {
      return scale_.asDiagonal() * coupling_[k] * scale_.template tail<n>().asDiagonal();
    };
    for (std::size_t k = 0; k < count; ++k) {
      Block s = scale_.asDiagonal() * diagonal_[k] * scale_.asDiagonal();
      s.diagonal().template head<m>().array() -= dual;
      s.diagonal().template tail<n>().array() += primal;
      if (k + 1 == count) s.template bottomRightCorner<n, n>().setIdentity();
      if (k > 0) {
        const Matrix<double, n, size> v = vectors_[k - 1].template bottomRows<n>();
        const Matrix<double, n, n> inverse = v * inverse_values_[k - 1].asDiagonal() * v.transpose();
        const Coupling c = scaled_coupling(k);
        s -= c * inverse * c.transpose();
      }
      const Eigen::SelfAdjointEigenSolver<Block> eigen(s);
      vectors_[k] = eigen.eigenvectors();
      for (int i = 0; i < size; ++i) {
        const double value = eigen.eigenvalues()(i);
        inertia.negative += value < 0;
        inertia.smallest = std::min(inertia.smallest, std::abs(value));
        const double safe = std::abs(value) < 1e-300 ? 1e-300 : value;
        inverse_values_[k](i) = 1 / safe;
      }
    }
    return inertia;
  }

  /// Solves the factored system for a right-hand side in scaled unknowns.
  Columns solve(Columns b) const {
    const std::size_t count = b.size();
    const auto apply_inverse = [&](std::size_t k, const Column& x) -> Column {
      return vectors_[k] * inverse_values_[k].cwiseProduct(vectors_[k].transpose() * x);
    };
    const auto tail_scale = scale_.template tail<n>();
    for (std::size_t k = 1; k < count; ++k) {
      const Vector<double, n> y = apply_inverse(k - 1, b[k - 1]).template tail<n>().cwiseProduct(tail_scale);
      b[k] -= scale_.cwiseProduct(coupling_[k] * y);
    }
    for (std::size_t k = count; k-- > 0;) {
      Column rhs = b[k];
      if (k + 1 < count) {
        const Column z = scale_.cwiseProduct(b[k + 1]);
        rhs.template tail<n>() -= tail_scale.cwiseProduct(coupling_[k + 1].transpose() * z);
      }
      b[k] = apply_inverse(k, rhs);
    }
    return b;
  }

  /// The matrix (without regularisation) times a vector, in scaled unknowns.
  Columns multiply(const Columns& z) const {
    const std::size_t count = z.size();
    Columns out(count);
    for (std::size_t k = 0; k < count; ++k) {
      Column sum = diagonal_[k] * scale_.cwiseProduct(z[k]);
      if (k > 0) sum += coupling_[k] * scale_.cwiseProduct(z[k - 1]).template tail<n>();
      if (k + 1 < count) sum.template tail<n>() += coupling_[k + 1].transpose() * scale_.cwiseProduct(z[k + 1]);
      out[k] = scale_.cwiseProduct(sum);
    }
    out.back().template tail<n>() += z.back().template tail<n>();
    return out;
  }

  /// The equations' residual in scaled form.
  Columns scaled_residual() const {
    Columns out = residual_;
    for (Column& c : out) c = scale_.cwiseProduct(c);
    return out;
  }
  double residual_norm() const {
    double norm = 0;
    for (const Column& c : residual_) {
      if (!c.allFinite()) return std::numeric_limits<double>::quiet_NaN();
      norm = std::max(norm, scale_.cwiseProduct(c).cwiseAbs().maxCoeff());
    }
    return norm;
  }

  const std::vector<Vector<double, n>>& cost_gradient() const { return gradient_; }
  const Columns& residual() const { return residual_; }
  const Column& scale() const { return scale_; }
  long constraint_count() const { return long(diagonal_.size()) * m; }

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
      z.back().template tail<n>().setZero();
      for (int iteration = 0; iteration < 5; ++iteration) {
        z = solve(z);
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

  std::vector<Block> diagonal_;     // k: rows and columns z_k
  std::vector<Coupling> coupling_;  // k: rows z_k, columns v_{k-1}
  Columns residual_;
  std::vector<Vector<double, n>> gradient_;  // of the cost alone
  Column scale_ = Column::Ones();
  std::vector<Block> vectors_;
  std::vector<Column> inverse_values_;
};

}  // namespace lagroid
