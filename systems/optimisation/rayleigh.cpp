#include <lagroid/systems/optimisation/rayleigh.hpp>

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

}  // namespace lagroid::optimisation
