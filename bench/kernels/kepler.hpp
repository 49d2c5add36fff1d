#pragma once
/// The planar Kepler problem with the midpoint rule, by hand.

#include "extrapolation.hpp"
#include "vectors.hpp"

#include <cmath>
#include <limits>

namespace kernels {

/// L(q0, q1) = |q1 - q0|^2 / (2 h) + h k / |m|, m = (q0 + q1)/2. With p = F- the midpoint solves
///
///     m + a m / |m|^3 = c,     c = q + h p / 2,  a = h^2 k / 4,
///
/// and then p' = p - h k m / |m|^3, q' = q + h (p + p') / 2. The matrix, with n = m/|m| and y = a/|m|^3, is
/// (1 + y) I - 3 y n n^T, whose inverse is (I + 3 y / (1 - 2 y) n n^T) / (1 + y).
///
/// Newton's method starts from c plus the extrapolated m - c (Degree 0: the last step's).
template <int Degree = 0> class Kepler {
 public:
  Kepler(double h, double strength, const Eigen::Vector2d& position, const Eigen::Vector2d& momentum)
      : h_(h), a_(0.25 * h * h * strength), position_(position), momentum_(momentum) {}

  void step() {
    const Pair c = position_ + 0.5 * h_ * momentum_;
    const double tolerance = round_off * (std::abs(c.x) + std::abs(c.y));
    Pair m = c + offset_.next();
    double y = 0;
    for (int iteration = 0;; ++iteration) {
      const double inverse_square = 1 / dot(m, m);
      y = a_ * inverse_square * std::sqrt(inverse_square);
      const Pair residual = m - c + y * m;
      if ((std::abs(residual.x) <= tolerance && std::abs(residual.y) <= tolerance) || iteration == max_iterations)
        break;
      const double along = 3 * y * inverse_square * dot(m, residual);
      const double scale = 1 / ((1 - 2 * y) * (1 + y));
      m = m - scale * ((1 - 2 * y) * residual + along * m);
    }
    offset_.record(m - c);
    const Pair impulse = (-4 * y / h_) * m;
    position_ = position_ + h_ * (momentum_ + 0.5 * impulse);
    momentum_ = momentum_ + impulse;
  }

  Eigen::Vector2d position() const { return position_.vector(); }
  Eigen::Vector2d momentum() const { return momentum_.vector(); }

 private:
  static constexpr int max_iterations = 20;
  static constexpr double round_off = 2 * std::numeric_limits<double>::epsilon();

  double h_;
  double a_;
  Pair position_;
  Pair momentum_;
  Extrapolation<Pair, Degree> offset_;
};

}  // namespace kernels
