#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/matrices/matrix_functions.hpp>
#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>

#include <fmt/format.h>
#include <Eigen/LU>

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace lagroid::optimisation {

namespace {

using Matrix = Eigen::MatrixXd;
using Map = Eigen::Map<Eigen::MatrixXd>;
using ConstMap = Eigen::Map<const Eigen::MatrixXd>;

}  // namespace

Stiefel::Stiefel(Eigen::Index n, Eigen::Index m) : n_(n), m_(m) {
  if (m < 1 || n < m) throw std::invalid_argument("a Stiefel manifold has 1 <= m <= n");
  tall_.resize(n, m);
  for (Matrix* small : {&product_, &skew_, &gram_, &normal_, &square_}) small->resize(m, m);
  factorisation_ = Eigen::HouseholderQR<Matrix>(n, m);
}

void Stiefel::gram_of(const Eigen::Ref<const Matrix>& a) const {
  gram_.setZero();
  gram_.triangularView<Eigen::Lower>() = a.transpose() * a;
  gram_.triangularView<Eigen::StrictlyUpper>() = gram_.transpose();
}

std::string Stiefel::name() const {
  return n_ == m_ ? fmt::format("orthogonal group O({})", n_) : fmt::format("Stiefel manifold St({}, {})", m_, n_);
}

double Stiefel::least_curvature() const { return m_ == 1 ? (n_ > 2 ? 1 : 0) : m_ == n_ ? 0 : -0.5; }
double Stiefel::diameter() const { return std::numbers::pi * std::sqrt(double(m_)); }

double Stiefel::residual(const Point& x) const {
  const ConstMap matrix(x.data(), n_, m_);
  gram_of(matrix);
  gram_.diagonal().array() -= 1;
  return 0.5 * gram_.cwiseAbs().maxCoeff();
}

double Stiefel::penalty(const Point& x, double weight, Vector& gradient) const {
  const ConstMap matrix(x.data(), n_, m_);
  gram_of(matrix);
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
  gram_of(matrix);
  gram_ *= -0.5;
  gram_.diagonal().array() += 0.5;
  tall_.noalias() = matrix * gram_;
  matrix += tall_;
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
