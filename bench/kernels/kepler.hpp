#pragma once
/// The planar Kepler problem with the midpoint rule, by hand.

#include "extrapolation.hpp"

#include <cmath>
#include <limits>

namespace kernels {

/// L(q0, q1) = |q1 - q0|^2 / (2 h) + h k / |m|, m = (q0 + q1)/2. With p = F- the midpoint solves
///
///     m + a m / |m|^3 = c,     c = q + h p / 2,  a = h^2 k / 4,
///
/// and then p' = p - h k m / |m|^3, q' = q + h (p + p') / 2. The matrix, with n = m/|m| and y = a/|m|^3, is
/// (1 + y) I - 3 y n n^T, whose inverse is (I + 3 y / (1 - 2 y) n n^T) / (1 + y).
class KeplerBase {
 public:
  const Eigen::Vector2d& position() const { return position_; }
  const Eigen::Vector2d& momentum() const { return momentum_; }

 protected:
  static constexpr int max_iterations = 20;
  static constexpr double round_off = 2 * std::numeric_limits<double>::epsilon();

  KeplerBase(double h, double strength, const Eigen::Vector2d& position, const Eigen::Vector2d& momentum)
      : h_(h), a_(0.25 * h * h * strength), position_(position), momentum_(momentum) {}

  Eigen::Vector2d half_way() const { return position_ + 0.5 * h_ * momentum_; }
  void accept(const Eigen::Vector2d& impulse) {
    position_ += h_ * (momentum_ + 0.5 * impulse);
    momentum_ += impulse;
  }

  double h_;
  double a_;

 private:
  Eigen::Vector2d position_;
  Eigen::Vector2d momentum_;
};

/// Newton's method in the plane, from c plus the extrapolated m - c (Degree 0: the last step's).
template <int Degree = 0> class Kepler : public KeplerBase {
 public:
  Kepler(double h, double strength, const Eigen::Vector2d& position, const Eigen::Vector2d& momentum)
      : KeplerBase(h, strength, position, momentum) {}

  void step() {
    const Eigen::Vector2d c = half_way();
    const double tolerance = round_off * c.lpNorm<Eigen::Infinity>();
    Eigen::Vector2d m = c + offset_.next();
    double y = 0;
    for (int iteration = 0;; ++iteration) {
      const double inverse_square = 1 / m.squaredNorm();
      y = a_ * inverse_square * std::sqrt(inverse_square);
      const Eigen::Vector2d residual = m - c + y * m;
      if (residual.lpNorm<Eigen::Infinity>() <= tolerance || iteration == max_iterations) break;
      const double along = 3 * y * inverse_square * m.dot(residual);
      const double scale = 1 / ((1 - 2 * y) * (1 + y));
      m -= scale * ((1 - 2 * y) * residual + along * m);
    }
    offset_.record(m - c);
    accept((-4 * y / h_) * m);
  }

 private:
  Extrapolation<2, Degree> offset_{Eigen::Vector2d::Zero()};
};

/// The same step by the symmetry of the potential: m is parallel to c, and its length solves the scalar equation
/// s + a / s^2 = |c|. What can be had by hand, but not from a potential that is not known to be central.
template <int Degree = 0> class KeplerRadial : public KeplerBase {
 public:
  KeplerRadial(double h, double strength, const Eigen::Vector2d& position, const Eigen::Vector2d& momentum)
      : KeplerBase(h, strength, position, momentum) {}

  void step() {
    const Eigen::Vector2d c = half_way();
    const double length = c.norm();
    double s = length + offset_.next()(0);
    double y = 0;
    for (int iteration = 0;; ++iteration) {
      const double inverse = 1 / s;
      const double shift = a_ * inverse * inverse;
      const double residual = s - length + shift;
      y = shift * inverse;
      if (std::abs(residual) <= round_off * length || iteration == max_iterations) break;
      s -= residual / (1 - 2 * y);
    }
    offset_.record(Eigen::Matrix<double, 1, 1>(s - length));
    accept((-4 * y / h_ * s / length) * c);
  }

 private:
  Extrapolation<1, Degree> offset_{Eigen::Matrix<double, 1, 1>::Zero()};
};

}  // namespace kernels
