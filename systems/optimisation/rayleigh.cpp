#include <lagroid/systems/optimisation/rayleigh.hpp>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace lagroid::optimisation {

namespace {

using Map = Eigen::Map<Eigen::MatrixXd>;
using ConstMap = Eigen::Map<const Eigen::MatrixXd>;

double width(const SymmetricOperator& a) {
  const auto [low, high] = spectrum(a);
  return high - low;
}

}  // namespace

Rayleigh::Rayleigh(SymmetricOperator a) : a_(std::move(a)), lipschitz_(2 * width(a_)) {}

double Rayleigh::evaluate(const Point& x, Vector& gradient) const {
  Map column(gradient.data(), a_.size, 1);
  a_.apply(ConstMap(x.data(), a_.size, 1), column);
  const double value = -x.dot(gradient);
  gradient *= -2;
  return value;
}

void Rayleigh::hessian(const Point&, const Vector& v, Vector& h) const {
  h.resize(v.size());
  Map column(h.data(), a_.size, 1);
  a_.apply(ConstMap(v.data(), a_.size, 1), column);
  h *= -2;
}

std::vector<ParameterTable> Rayleigh::parameters() const { return {{"A", a_.size, a_.size, true}}; }

double Rayleigh::parameter(const ParameterEntry& which) const { return entry_of(a_, which.row, which.column); }

double Rayleigh::by_parameter(const ParameterEntry& which, const Point& x, Vector& gradient) const {
  gradient.setZero(x.size());
  const double twice = which.row == which.column ? 1 : 2;
  gradient(which.row) -= twice * x(which.column);
  gradient(which.column) -= twice * x(which.row);
  return -twice * x(which.row) * x(which.column);
}

std::unique_ptr<ParametricObjective> Rayleigh::changed(const ParameterEntry& which, double by) const {
  auto out = std::make_unique<Rayleigh>(*this);
  out->a_ = with_changed_entry(a_, which.row, which.column, by);
  out->lipschitz_ += 4 * std::abs(by);
  return out;
}

Brockett::Brockett(SymmetricOperator a, Eigen::VectorXd weights)
    : a_(std::move(a)), weights_(std::move(weights)), lipschitz_(0) {
  if (weights_.size() < 1 || weights_.size() > a_.size)
    throw std::invalid_argument("Brockett: give one to n weights for an n x n matrix");
  for (Eigen::Index i = 0; i < weights_.size(); ++i)
    if (!(weights_(i) >= (i > 0 ? weights_(i - 1) : 0)))
      throw std::invalid_argument("Brockett: the weights have to satisfy 0 <= mu_1 <= ... <= mu_m");
  lipschitz_ = 2 * width(a_) * weights_(weights_.size() - 1);
}

double Brockett::evaluate(const Point& x, Vector& gradient) const {
  const ConstMap point(x.data(), a_.size, weights_.size());
  Map slope(gradient.data(), a_.size, weights_.size());
  a_.apply(point, slope);
  double value = 0;
  for (Eigen::Index j = 0; j < weights_.size(); ++j) {
    value += weights_(j) * point.col(j).dot(slope.col(j));
    slope.col(j) *= 2 * weights_(j);
  }
  return value;
}

void Brockett::hessian(const Point&, const Vector& v, Vector& h) const {
  h.resize(v.size());
  Map along(h.data(), a_.size, weights_.size());
  a_.apply(ConstMap(v.data(), a_.size, weights_.size()), along);
  for (Eigen::Index j = 0; j < weights_.size(); ++j) along.col(j) *= 2 * weights_(j);
}

std::vector<ParameterTable> Brockett::parameters() const {
  return {{"weights", weights_.size()}, {"A", a_.size, a_.size, true}};
}

double Brockett::parameter(const ParameterEntry& which) const {
  return which.table == 0 ? weights_(which.row) : entry_of(a_, which.row, which.column);
}

double Brockett::by_parameter(const ParameterEntry& which, const Point& x, Vector& gradient) const {
  const ConstMap point(x.data(), a_.size, weights_.size());
  gradient.setZero(x.size());
  Map slope(gradient.data(), a_.size, weights_.size());
  if (which.table == 0) {
    Eigen::MatrixXd product(a_.size, 1);
    a_.apply(point.col(which.row), product);
    slope.col(which.row) = 2 * product;
    return point.col(which.row).dot(product.col(0));
  }
  // Trace(X^T E X N) with E of ones at (i, j) and (j, i), or of one.
  const double twice = which.row == which.column ? 1 : 2;
  double value = 0;
  for (Eigen::Index j = 0; j < weights_.size(); ++j) {
    const double here = point(which.row, j), there = point(which.column, j);
    value += twice * weights_(j) * here * there;
    slope(which.row, j) += twice * weights_(j) * there;
    slope(which.column, j) += twice * weights_(j) * here;
  }
  return value;
}

std::unique_ptr<ParametricObjective> Brockett::changed(const ParameterEntry& which, double by) const {
  if (which.table == 0) {
    Eigen::VectorXd weights = weights_;
    weights(which.row) += by;
    return std::make_unique<Brockett>(a_, weights);
  }
  auto out = std::make_unique<Brockett>(*this);
  out->a_ = with_changed_entry(a_, which.row, which.column, by);
  out->lipschitz_ += 4 * std::abs(by) * weights_(weights_.size() - 1);
  return out;
}

}  // namespace lagroid::optimisation
