#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/solvers/optimisation/manifolds/positive_definite.hpp>

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace lagroid::optimisation {

namespace {

using Map = Eigen::Map<Eigen::MatrixXd>;
using ConstMap = Eigen::Map<const Eigen::MatrixXd>;

}  // namespace

PositiveDefinite::PositiveDefinite(Eigen::Index n) : n_(n) {
  if (n < 1) throw std::invalid_argument("positive definite matrices have one row or more");
  factorised_ = Point::Zero(n * n);  // which is not positive
  factor_ = Eigen::LLT<Matrix>(n);
  for (Matrix* each : {&one_, &other_, &product_}) each->resize(n, n);
}

std::string PositiveDefinite::name() const { return fmt::format("space P({}) of positive definite matrices", n_); }

/// L into factor_. False where X is not positive definite.
bool PositiveDefinite::factorise(const Point& x) const {
  if (x == factorised_) return positive_;
  factorised_ = x;
  factor_.compute(ConstMap(x.data(), n_, n_));
  positive_ = x.allFinite() && factor_.info() == Eigen::Success;
  return positive_;
}

/// L^-1 V L^-T.
void PositiveDefinite::reduce(const Vector& v, Matrix& out) const {
  out = ConstMap(v.data(), n_, n_);
  factor_.matrixL().solveInPlace(out);
  factor_.matrixU().solveInPlace<Eigen::OnTheRight>(out);
}

void PositiveDefinite::symmetric_part(const Vector& v, Matrix& out) const {
  const ConstMap matrix(v.data(), n_, n_);
  out = 0.5 * (matrix + matrix.transpose());
}

double PositiveDefinite::residual(const Point& x) const {
  const ConstMap matrix(x.data(), n_, n_);
  if (!factorise(x)) return std::numeric_limits<double>::infinity();
  return 0.5 * (matrix - matrix.transpose()).cwiseAbs().maxCoeff();
}

double PositiveDefinite::penalty(const Point& x, double weight, Vector& gradient) const {
  const ConstMap matrix(x.data(), n_, n_);
  one_ = 0.5 * (matrix - matrix.transpose());
  Map(gradient.data(), n_, n_) += weight * one_;
  return 0.5 * weight * one_.squaredNorm();
}

bool PositiveDefinite::nearest(Point& x) const {
  project(x, x);
  return factorise(x);
}

void PositiveDefinite::project(const Point&, Vector& v) const {
  symmetric_part(v, one_);
  Map(v.data(), n_, n_) = one_;
}

double PositiveDefinite::inner(const Point& x, const Vector& u, const Vector& v) const {
  if (!factorise(x)) return std::numeric_limits<double>::quiet_NaN();
  reduce(u, one_);
  if (&u == &v) return one_.squaredNorm();
  reduce(v, other_);
  return one_.cwiseProduct(other_).sum();
}

void PositiveDefinite::gradient(const Point& x, Vector& differential) const {
  const ConstMap point(x.data(), n_, n_);
  symmetric_part(differential, one_);
  product_.noalias() = point * one_;
  Map(differential.data(), n_, n_).noalias() = product_ * point;
  project(x, differential);
}

void PositiveDefinite::differential(const Point& x, Vector& gradient) const {
  factorise(x);
  Map v(gradient.data(), n_, n_);
  one_ = v;
  factor_.solveInPlace(one_);
  v = one_.transpose();
  factor_.solveInPlace(v);
  project(x, gradient);
}

bool PositiveDefinite::exponential(const Point& x, const Vector& v, Point& to) const {
  if (!factorise(x)) return false;
  reduce(v, one_);
  if (!one_.allFinite()) return false;
  const auto [values, u] = symmetric_eigenvectors(one_);
  // B B^T with B = L U exp(values / 2): symmetric and positive whatever rounding does.
  product_ = u * (0.5 * values.array()).exp().matrix().asDiagonal();
  one_.noalias() = factor_.matrixL() * product_;
  to.resize(size());
  Map end(to.data(), n_, n_);
  other_.setZero();
  other_.selfadjointView<Eigen::Lower>().rankUpdate(one_);
  end = other_.selfadjointView<Eigen::Lower>();
  return to.allFinite();
}

bool PositiveDefinite::logarithms(const Point& x, const Point& y, Eigen::VectorXd& s, Matrix& u) const {
  if (!factorise(x)) return false;
  reduce(y - x, one_);
  // Of matrices that are near the eigenvalues of X^-1 (Y - X) are small; of others those of X^-1 Y may be.
  constexpr double near = 0.5;
  const bool is_near = one_.norm() < near;
  if (!is_near) reduce(y, one_);
  if (!one_.allFinite()) return false;
  const auto found = symmetric_eigenvectors(one_);
  s = found.values;
  u = found.vectors;
  for (double& value : s) value = is_near ? std::log1p(value) : std::log(value);
  return s.allFinite();
}

bool PositiveDefinite::logarithm(const Point& x, const Point& y, Vector& v) const {
  Eigen::VectorXd values;
  Matrix u;
  if (!logarithms(x, y, values, u)) return false;
  v.resize(size());
  product_.noalias() = factor_.matrixL() * u;
  one_.noalias() = product_ * values.asDiagonal();
  Map(v.data(), n_, n_).noalias() = one_ * product_.transpose();
  project(x, v);
  return v.allFinite();
}

bool PositiveDefinite::parallel_transport(const Point& from, const Point& to, Vector& v) const {
  if (!factorise(from)) return false;
  reduce(to, one_);
  if (!one_.allFinite()) return false;
  const auto [values, u] = symmetric_eigenvectors(one_);
  reduce(v, other_);
  // L S (L^-1 V L^-T) S L^T, S = U values^(1/2) U^T.
  one_.noalias() = u * values.cwiseSqrt().asDiagonal() * u.transpose();
  product_.noalias() = one_ * other_;
  other_.noalias() = product_ * one_;
  one_.noalias() = factor_.matrixL() * other_;
  Map(v.data(), n_, n_).noalias() = one_ * factor_.matrixU();
  project(to, v);
  return v.allFinite();
}

template <class Factor>
bool PositiveDefinite::stretch_entries(const Point& x, const Point& y, const Factor& factor, Vector& v) const {
  Eigen::VectorXd s;
  Matrix u;
  if (!logarithms(x, y, s, u)) return false;
  reduce(v, one_);
  product_.noalias() = u.transpose() * one_;
  one_.noalias() = product_ * u;
  for (Eigen::Index j = 0; j < n_; ++j)
    for (Eigen::Index i = 0; i < n_; ++i) one_(i, j) *= factor(s(i), s(j));
  product_.noalias() = factor_.matrixL() * u;
  other_.noalias() = product_ * one_;
  Map(v.data(), n_, n_).noalias() = other_ * product_.transpose();
  project(x, v);
  return v.allFinite();
}

bool PositiveDefinite::logarithm_by_end(const Point& x, const Point& y, Vector& v) const {
  return stretch_entries(
      x, y,
      [](double a, double b) {
        const double t = 0.5 * (a - b);
        return std::exp(-0.5 * (a + b)) * (t != 0 ? t / std::sinh(t) : 1);
      },
      v);
}

bool PositiveDefinite::logarithm_by_start(const Point& x, const Point& y, Vector& v) const {
  return stretch_entries(
      x, y,
      [](double a, double b) {
        const double t = 0.5 * (a - b);
        return t != 0 ? -t / std::tanh(t) : -1;
      },
      v);
}

void PositiveDefinite::hessian(const Point& x, const Vector& gradient, const Vector& v, Vector& h) const {
  const ConstMap point(x.data(), n_, n_);
  this->gradient(x, h);
  symmetric_part(gradient, one_);
  product_.noalias() = one_ * point;
  Map(h.data(), n_, n_).noalias() += ConstMap(v.data(), n_, n_) * product_;
  project(x, h);
}

}  // namespace lagroid::optimisation
