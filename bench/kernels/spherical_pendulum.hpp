#pragma once
/// The spherical pendulum by SHAKE, by hand.

#include "vectors.hpp"

#include <cmath>

namespace kernels {

/// L(q0, q1) = m |q1 - q0|^2 / (2 h) - h m g (e3.q0 + e3.q1) / 2 on |q| = l. A step is
///
///     q' = b + s q,  b = q + h p / m - h^2 g e3 / 2,      p' = p + (m s / h) q - h m g e3,
///
/// with lambda = m s / h the multiplier of (|q|^2 - l^2)/2, and |q'|^2 = l^2 a quadratic equation for s, of which the
/// root near zero is taken, in the form without cancellation. No iteration. The momentum is the unprojected one.
class SphericalPendulum {
 public:
  SphericalPendulum(double h, double mass, double length, double gravity, const Eigen::Vector3d& position,
                    const Eigen::Vector3d& momentum)
      : square_length_(length * length),
        drift_(h / mass),
        rate_(mass / h),
        fall_(0.5 * h * h * gravity),
        weight_(h * mass * gravity),
        position_(position),
        momentum_(momentum) {}

  void step() {
    Triple b = position_ + drift_ * momentum_;
    b.z -= fall_;
    const double excess = dot(b, b) - square_length_;
    const double along = dot(b, position_);
    const double s = -excess / (along + std::sqrt(along * along - dot(position_, position_) * excess));
    momentum_ = momentum_ + (rate_ * s) * position_;
    momentum_.z -= weight_;
    position_ = b + s * position_;
    multiplier_ = rate_ * s;
  }

  Eigen::Vector3d position() const { return position_.vector(); }
  Eigen::Vector3d momentum() const { return momentum_.vector(); }
  /// lambda of the last step.
  double multiplier() const { return multiplier_; }

 private:
  double square_length_;
  double drift_;
  double rate_;
  double fall_;
  double weight_;
  Triple position_;
  Triple momentum_;
  double multiplier_ = 0;
};

}  // namespace kernels
