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
  total_ = weights_.sum();
  weights_ /= total_;
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

/// At at_ along along_, where the manifold knows how all logarithms change.
bool FrechetMean::closed_hessian(Vector& h) const {
  h.setZero(at_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    log_ = along_;
    if (!manifold_.logarithm_by_start(at_, points_[i], log_)) return false;
    h -= weights_(Eigen::Index(i)) * log_;
  }
  return true;
}

/// The same by differences, with the length of along_.
void FrechetMean::difference_hessian(double length, Vector& h) const {
  h.setZero(at_.size());
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
  if (!closed_hessian(h)) difference_hessian(length, h);
  h -= normal_;
  manifold_.differential(at_, h);
}

std::vector<ParameterTable> FrechetMean::parameters() const {
  const auto count = Eigen::Index(points_.size());
  return {{"weights", count}, {"points", count, manifold_.size()}};
}

double FrechetMean::parameter(const ParameterEntry& which) const {
  return which.table == 0 ? weights_(which.row) * total_ : points_[std::size_t(which.row)](which.column);
}

double FrechetMean::by_parameter(const ParameterEntry& which, const Point& x, Vector& gradient) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const Point& point = points_[std::size_t(which.row)];
  double value = none;
  if (which.table == 0) {
    // Of sum W_i d_i^2 / 2 over sum W_i.
    const double mean = riemannian(x, gradient);
    if (!manifold_.logarithm(x, point, log_)) return none;
    value = (0.5 * manifold_.inner(x, log_, log_) - mean) / total_;
    gradient = (-log_ - gradient) / total_;
  } else {
    along_ = Vector::Unit(point.size(), which.column);
    manifold_.project(point, along_);
    if (!manifold_.logarithm(point, x, log_)) return none;
    const double weight = weights_(which.row);
    value = -weight * manifold_.inner(point, log_, along_);
    if (manifold_.logarithm_by_end(x, point, along_))
      gradient = -weight * along_;
    else
      gradient.setConstant(x.size(), none);
  }
  manifold_.differential(x, gradient);
  return value;
}

std::unique_ptr<ParametricObjective> FrechetMean::changed(const ParameterEntry& which, double by) const {
  Eigen::VectorXd weights = weights_ * total_;
  std::vector<Point> points = points_;
  if (which.table == 0) {
    weights(which.row) += by;
  } else {
    Point& point = points[std::size_t(which.row)];
    point(which.column) += by;
    if (!manifold_.nearest(point))
      throw std::invalid_argument(fmt::format("point {} would leave the {}", which.row + 1, manifold_.name()));
  }
  return std::make_unique<FrechetMean>(manifold_, std::move(points), weights);
}

}  // namespace lagroid::optimisation
