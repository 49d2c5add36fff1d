#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/systems/optimisation/procrustes.hpp>

#include <fmt/format.h>

#include <stdexcept>

namespace lagroid::optimisation {

namespace {

using Map = Eigen::Map<Eigen::MatrixXd>;
using ConstMap = Eigen::Map<const Eigen::MatrixXd>;

}  // namespace

Procrustes::Procrustes(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) : a_(a), b_(b) {
  if (a.rows() != b.rows())
    throw std::invalid_argument(
        fmt::format("Procrustes: A has {} rows and B {}; they need the same number", a.rows(), b.rows()));
  if (b.cols() > a.cols())
    throw std::invalid_argument(
        fmt::format("Procrustes: A has {} columns and B {}; B may have no more than A", a.cols(), b.cols()));
  residual_.resize(b.rows(), b.cols());
}

double Procrustes::evaluate(const Point& x, Vector& gradient) const {
  const double f = value(x);
  Map(gradient.data(), a_.cols(), b_.cols()).noalias() = 2 * a_.transpose() * residual_;
  return f;
}

double Procrustes::value(const Point& x) const {
  residual_ = -b_;
  residual_.noalias() += a_ * ConstMap(x.data(), a_.cols(), b_.cols());
  return residual_.squaredNorm();
}

void Procrustes::hessian(const Point&, const Vector& v, Vector& h) const {
  h.resize(v.size());
  residual_.noalias() = a_ * ConstMap(v.data(), a_.cols(), b_.cols());
  Map(h.data(), a_.cols(), b_.cols()).noalias() = 2 * a_.transpose() * residual_;
}

std::vector<ParameterTable> Procrustes::parameters() const {
  return {{"A", a_.rows(), a_.cols()}, {"B", b_.rows(), b_.cols()}};
}

double Procrustes::parameter(const ParameterEntry& which) const {
  return which.table == 0 ? a_(which.row, which.column) : b_(which.row, which.column);
}

double Procrustes::by_parameter(const ParameterEntry& which, const Point& x, Vector& gradient) const {
  const ConstMap point(x.data(), a_.cols(), b_.cols());
  gradient.setZero(x.size());
  Map slope(gradient.data(), a_.cols(), b_.cols());
  // R = A X - B, f = |R|^2, D f = 2 A^T R.
  const Eigen::RowVectorXd left = a_.row(which.row) * point - b_.row(which.row);
  if (which.table == 1) {
    slope.col(which.column) = -2 * a_.row(which.row).transpose();
    return -2 * left(which.column);
  }
  slope.row(which.column) = 2 * left;
  slope.noalias() += 2 * a_.row(which.row).transpose() * point.row(which.column);
  return 2 * left.dot(point.row(which.column));
}

std::unique_ptr<ParametricObjective> Procrustes::changed(const ParameterEntry& which, double by) const {
  auto out = std::make_unique<Procrustes>(*this);
  (which.table == 0 ? out->a_ : out->b_)(which.row, which.column) += by;
  return out;
}

Eigen::MatrixXd balanced_procrustes(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, int component) {
  auto [values, u, v] = singular_vectors(a.transpose() * b);
  const double sign = determinant_of(u * v.transpose());
  if (component != 0 && sign * component < 0) u.col(u.cols() - 1) *= -1;
  return u * v.transpose();
}

}  // namespace lagroid::optimisation
