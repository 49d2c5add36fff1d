#include <lagroid/systems/optimisation/frechet_mean.hpp>

#include <fmt/format.h>

#include <limits>
#include <stdexcept>
#include <utility>

namespace lagroid::optimisation {

FrechetMean::FrechetMean(const Manifold& manifold, std::vector<Point> points, const Eigen::VectorXd& weights)
    : manifold_(manifold), points_(std::move(points)), weights_(weights) {
  if (points_.empty()) throw std::invalid_argument("a mean is one of one point or more");
  constexpr double on_it = 1e-8;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (points_[i].size() != manifold.size())
      throw std::invalid_argument(fmt::format("point {} has {} numbers, points of the {} have {}", i + 1,
                                              points_[i].size(), manifold.name(), manifold.size()));
    if (!(manifold.residual(points_[i]) <= on_it))
      throw std::invalid_argument(
          fmt::format("point {} is not on the {}; take its nearest point, where there is one", i + 1, manifold.name()));
  }
  if (weights_.size() == 0) weights_.setOnes(Eigen::Index(points_.size()));
  if (weights_.size() != Eigen::Index(points_.size()) || !(weights_.minCoeff() > 0) || !weights_.allFinite())
    throw std::invalid_argument(fmt::format("give a positive weight for each of the {} points", points_.size()));
  weights_ /= weights_.sum();
}

/// f and its Riemannian gradient at a point of the manifold.
double FrechetMean::riemannian(const Point& x, Vector& gradient) const {
  gradient.setZero(x.size());
  double value = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double weight = weights_(Eigen::Index(i));
    if (!manifold_.logarithm(x, points_[i], log_)) {
      gradient.setConstant(std::numeric_limits<double>::quiet_NaN());
      return std::numeric_limits<double>::quiet_NaN();
    }
    gradient -= weight * log_;
    value += 0.5 * weight * manifold_.inner(x, log_, log_);
  }
  return value;
}

double FrechetMean::evaluate(const Point& x, Vector& gradient) const {
  at_ = x;
  if (!manifold_.nearest(at_)) {
    gradient.setConstant(x.size(), std::numeric_limits<double>::quiet_NaN());
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double value = riemannian(at_, gradient);
  manifold_.differential(at_, gradient);
  return value;
}

void FrechetMean::hessian(const Point& x, const Vector& v, Vector& h) const {
  evaluate(x, change_);  // D f, and at_
  along_ = v;
  manifold_.project(at_, along_);
  const double length = manifold_.norm(at_, along_);
  h.setZero(x.size());
  if (!(length > 0)) return;
  // What the manifold makes of D f is taken from what it is to make of h.
  normal_.setZero(x.size());
  manifold_.hessian(at_, change_, along_, normal_);
  // Truncation and rounding balance at the cube root of the precision.
  const double step = 6e-6 / length;
  for (const double side : {step, -step}) {
    log_ = side * along_;
    if (!manifold_.retract(ManifoldRetraction::exponential, at_, log_, moved_)) {
      h.setConstant(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    riemannian(moved_, change_);
    manifold_.transport(moved_, at_, change_);
    h += change_ / (2 * side);
  }
  h -= normal_;
  manifold_.differential(at_, h);
}

}  // namespace lagroid::optimisation
