#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/matrices/matrix_functions.hpp>
#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

// Apart from the rest of the manifold: together they take the compiler more than twice as long.
namespace lagroid::optimisation {

namespace {

using Matrix = Eigen::MatrixXd;
using Map = Eigen::Map<Eigen::MatrixXd>;
using ConstMap = Eigen::Map<const Eigen::MatrixXd>;

/// The largest singular value of V, of which `gram` is V^T V.
double spectral_norm(const Matrix& gram) {
  return std::sqrt(std::max(0.0, symmetric_eigenvalues(gram)(gram.rows() - 1)));
}

}  // namespace

bool Stiefel::qr(Matrix& y) const {
  factorisation_.compute(y);
  const auto diagonal = factorisation_.matrixQR().diagonal();
  if (!diagonal.allFinite() || diagonal.cwiseAbs().minCoeff() == 0) return false;
  y.setIdentity();
  y.applyOnTheLeft(factorisation_.householderQ());
  for (Eigen::Index j = 0; j < m_; ++j)
    if (diagonal(j) < 0) y.col(j) = -y.col(j);
  return true;
}

bool Stiefel::retract(ManifoldRetraction retraction, const Point& x, const Vector& v, Point& to) const {
  if (retraction == ManifoldRetraction::orthographic) return orthographic(x, v, to, moved_);
  to.resize(size());
  const ConstMap point(x.data(), n_, m_);
  const ConstMap vector(v.data(), n_, m_);
  Map end(to.data(), n_, m_);
  switch (retraction) {
    case ManifoldRetraction::qr:
      tall_ = point + vector;
      if (!qr(tall_)) return false;
      end = tall_;
      return true;
    case ManifoldRetraction::polar: {
      gram_of(vector);
      if (!gram_.allFinite()) return false;
      const auto [values, u] = symmetric_eigenvectors(gram_);
      const Eigen::VectorXd roots = (1 + values.array().max(0)).rsqrt();
      tall_ = point + vector;
      square_.noalias() = u * roots.asDiagonal() * u.transpose();
      end.noalias() = tall_ * square_;
      break;
    }
    case ManifoldRetraction::cayley: {
      product_.noalias() = point.transpose() * vector;
      tall_ = vector;
      tall_.noalias() -= 0.5 * point * product_;  // A = V - X X^T V / 2
      Matrix small(2 * m_, 2 * m_);
      Matrix right(2 * m_, m_);
      gram_of(tall_);
      small.topLeftCorner(m_, m_) = -0.25 * product_;
      small.topRightCorner(m_, m_) = -0.5 * Matrix::Identity(m_, m_);
      small.bottomLeftCorner(m_, m_) = 0.5 * gram_;
      small.bottomRightCorner(m_, m_) = -0.25 * product_;
      small.diagonal().array() += 1;
      right.topRows(m_).setIdentity();
      right.bottomRows(m_) = 0.5 * product_;
      const Matrix k = small.partialPivLu().solve(right);
      end = point;
      end.noalias() += tall_ * k.topRows(m_);
      end.noalias() += point * k.bottomRows(m_);
      break;
    }
    case ManifoldRetraction::exponential: {
      // (X, V) exp((C, -V^T V), (I, C)) (I, 0)^T exp(-C), C = X^T V.
      product_.noalias() = point.transpose() * vector;
      gram_of(vector);
      if (!gram_.allFinite()) return false;
      Matrix generator(2 * m_, 2 * m_);
      generator.topLeftCorner(m_, m_) = product_;
      generator.topRightCorner(m_, m_) = -gram_;
      generator.bottomLeftCorner(m_, m_).setIdentity();
      generator.bottomRightCorner(m_, m_) = product_;
      const Matrix flow = matrix_exponential(generator);
      const Matrix back = matrix_exponential(-product_);
      const Matrix k = flow.leftCols(m_) * back;
      end.noalias() = point * k.topRows(m_);
      end.noalias() += vector * k.bottomRows(m_);
      break;
    }
    case ManifoldRetraction::orthographic:
      break;
  }
  if (!to.allFinite()) return false;
  polish(to);
  return true;
}

/// T of `orthographic` into normal_, from W in skew_ and B^T B + W^T W in gram_.
bool Stiefel::multipliers() const {
  // An iteration of Newton's method costs about as much as a hundred of the fixed point.
  constexpr int most_fixed = 60;
  constexpr double slow = 0.5;
  constexpr int most = 12;
  constexpr double round_off = 1e-16;
  normal_ = -0.5 * gram_;
  const auto residual = [&] {
    square_.noalias() = normal_ * normal_;
    product_.noalias() = normal_ * skew_;
    square_ += 2 * normal_ + product_ + product_.transpose() + gram_;
  };
  double last = INFINITY;
  for (int k = 0; k < most_fixed; ++k) {
    residual();
    const double size = square_.norm();
    if (!std::isfinite(size)) return false;
    if (size <= round_off * std::max(1.0, gram_.norm())) return true;
    if (size > slow * last) break;
    normal_ -= 0.5 * square_;
    last = size;
  }
  // W is the skew part of S + W, and (S + W)^T (S + W) = I - B^T B.
  product_.noalias() = skew_.transpose() * skew_;
  if (spectral_norm(product_) >= 1) return false;
  square_ = gram_ - product_;
  if (spectral_norm(square_) >= 1) return false;
  if (n_ == m_) {
    // S = (I - W^T W)^(1/2).
    auto [t, u] = symmetric_eigenvectors(gram_);
    for (double& w : t) w = -w / (1 + std::sqrt(std::max(0.0, 1 - w)));
    normal_.noalias() = u * t.asDiagonal() * u.transpose();
    return true;
  }
  for (int k = 0; k < most; ++k) {
    residual();
    const double size = square_.norm();
    if (!std::isfinite(size)) return false;
    // S + W has the spectrum in the right half plane on the branch of S = I.
    Matrix change;
    Matrix sum = normal_ + skew_;
    sum.diagonal().array() += 1;
    if (!solve_lyapunov(sum, square_, change)) return false;
    normal_ -= 0.5 * (change + change.transpose());
    if (change.norm() <= 4e-16 * double(m_)) {
      return symmetric_eigenvalues(normal_)(0) > -1;
    }
  }
  return false;
}

bool Stiefel::orthographic(const Point& x, const Vector& z, Point& to, Vector& moved) const {
  const ConstMap point(x.data(), n_, m_);
  moved = z;
  Map b(moved.data(), n_, m_);
  product_.noalias() = point.transpose() * b;
  b.noalias() -= point * product_;
  skew_ = 0.5 * (product_ - product_.transpose());
  gram_of(b);
  gram_.noalias() += skew_.transpose() * skew_;
  if (!multipliers()) return false;
  normal_ += skew_;
  b.noalias() += point * normal_;
  to = x + moved;
  polish(to);
  return true;
}

double Stiefel::reach(const Vector& v) const {
  const ConstMap vector(v.data(), n_, m_);
  gram_of(vector);
  return gram_.allFinite() ? spectral_norm(gram_) : std::numeric_limits<double>::infinity();
}

}  // namespace lagroid::optimisation
