#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/matrices/matrix_functions.hpp>
#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace lagroid::optimisation {

namespace {

using Matrix = Eigen::MatrixXd;
using Map = Eigen::Map<Matrix>;
using ConstMap = Eigen::Map<const Matrix>;

/// a^T b, where a^T b is known to be symmetric.
template <class A, class B> void symmetric_product(const A& a, const B& b, Matrix& out) {
  out.setZero();
  out.template triangularView<Eigen::Lower>() = a.transpose() * b;
  out.template triangularView<Eigen::StrictlyUpper>() = out.transpose();
}

/// The largest singular value of V, of which `gram` is V^T V.
double spectral_norm(const Matrix& gram) {
  return std::sqrt(std::max(0.0, symmetric_eigenvalues(gram)(gram.rows() - 1)));
}

}  // namespace

Stiefel::Stiefel(Eigen::Index n, Eigen::Index m) : n_(n), m_(m) {
  if (m < 1 || n < m) throw std::invalid_argument("a Stiefel manifold has 1 <= m <= n");
  tall_.resize(n, m);
  for (Matrix* small : {&product_, &skew_, &gram_, &normal_, &square_}) small->resize(m, m);
  factorisation_ = Eigen::HouseholderQR<Matrix>(n, m);
}

std::string Stiefel::name() const {
  return n_ == m_ ? fmt::format("orthogonal group O({})", n_) : fmt::format("Stiefel manifold St({}, {})", m_, n_);
}

double Stiefel::least_curvature() const { return m_ == 1 ? (n_ > 2 ? 1 : 0) : m_ == n_ ? 0 : -0.5; }
double Stiefel::diameter() const { return std::numbers::pi * std::sqrt(double(m_)); }

double Stiefel::residual(const Point& x) const {
  const ConstMap matrix(x.data(), n_, m_);
  symmetric_product(matrix, matrix, gram_);
  gram_.diagonal().array() -= 1;
  return 0.5 * gram_.cwiseAbs().maxCoeff();
}

double Stiefel::penalty(const Point& x, double weight, Vector& gradient) const {
  const ConstMap matrix(x.data(), n_, m_);
  symmetric_product(matrix, matrix, gram_);
  gram_.diagonal().array() -= 1;
  gram_ *= 0.5;
  Map(gradient.data(), n_, m_).noalias() += weight * matrix * gram_;
  return 0.5 * weight * gram_.squaredNorm();
}

bool Stiefel::nearest(Point& x) const {
  Map matrix(x.data(), n_, m_);
  if (!matrix.allFinite()) return false;
  // X = Q R, and R = U D V^T small: the polar factor is Q U V^T.
  tall_ = matrix;
  factorisation_.compute(tall_);
  const Matrix r = factorisation_.matrixQR().topRows(m_).triangularView<Eigen::Upper>();
  const auto [values, u, v] = singular_vectors(r);
  if (!(values(m_ - 1) > double(n_) * 1e-16 * values(0))) return false;
  tall_.setZero();
  tall_.topRows(m_) = u * v.transpose();
  tall_.applyOnTheLeft(factorisation_.householderQ());
  matrix = tall_;
  polish(x);
  return true;
}

void Stiefel::project(const Point& x, Vector& v) const {
  const ConstMap point(x.data(), n_, m_);
  Map vector(v.data(), n_, m_);
  product_.noalias() = point.transpose() * vector;
  square_ = 0.5 * (product_ + product_.transpose());
  vector.noalias() -= point * square_;
}

void Stiefel::polish(Point& x) const {
  Map matrix(x.data(), n_, m_);
  symmetric_product(matrix, matrix, gram_);
  gram_ *= -0.5;
  gram_.diagonal().array() += 0.5;
  tall_.noalias() = matrix * gram_;
  matrix += tall_;
}

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
      symmetric_product(vector, vector, gram_);
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
      symmetric_product(tall_, tall_, gram_);
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
      symmetric_product(vector, vector, gram_);
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
  symmetric_product(b, b, gram_);
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
  symmetric_product(vector, vector, gram_);
  return gram_.allFinite() ? spectral_norm(gram_) : std::numeric_limits<double>::infinity();
}

bool Stiefel::logarithm(const Point& x, const Point& y, Vector& v) const {
  if (m_ != n_) return false;
  const ConstMap from(x.data(), n_, m_);
  const ConstMap to(y.data(), n_, m_);
  const Matrix turn = from.transpose() * to;
  if (component(turn) < 0) return false;
  // The logarithm of a real matrix with an eigenvalue -1 is no real one.
  constexpr double opposite = 1e-7;
  for (const std::complex<double>& value : matrix_eigenvalues(turn))
    if (std::abs(value + 1.0) < opposite) return false;
  const Matrix log = matrix_logarithm(turn);
  v.resize(size());
  Map(v.data(), n_, m_).noalias() = from * (0.5 * (log - log.transpose()));
  return true;
}

bool Stiefel::parallel_transport(const Point& from, const Point& to, Vector& v) const {
  if (!logarithm(from, to, moved_)) return false;
  const ConstMap point(from.data(), n_, m_);
  product_.noalias() = 0.5 * point.transpose() * Map(moved_.data(), n_, m_);
  square_ = matrix_exponential(product_);
  product_.noalias() = point.transpose() * Map(v.data(), n_, m_);
  skew_.noalias() = square_ * product_;
  tall_.noalias() = point * skew_;
  Map(v.data(), n_, m_).noalias() = tall_ * square_;
  return true;
}

void Stiefel::hessian(const Point& x, const Vector& gradient, const Vector& v, Vector& h) const {
  const ConstMap point(x.data(), n_, m_);
  const ConstMap slope(gradient.data(), n_, m_);
  const ConstMap vector(v.data(), n_, m_);
  product_.noalias() = point.transpose() * slope;
  square_ = 0.5 * (product_ + product_.transpose());
  Map(h.data(), n_, m_).noalias() -= vector * square_;
  project(x, h);
}

int component(const Eigen::Ref<const Eigen::MatrixXd>& x) { return x.partialPivLu().determinant() < 0 ? -1 : 1; }

}  // namespace lagroid::optimisation
