#pragma once
/// The initial-value problem of the plate-ball system in the trace form, by hand.

#include "attitude.hpp"
#include "extrapolation.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace kernels {

struct PlateBallParameters {
  double h = 0.05;
  double radius = 1;
  double plate_rate = 0;  ///< Omega
  double spin = 0;        ///< c
};

struct PlateBallState {
  Eigen::Vector2d position;         ///< (x, y)
  Eigen::Vector2d linear_momentum;  ///< (px, py)
  Eigen::Vector3d body_momentum;    ///< M
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Identity();
};

/// One step of [G] 6.2 has eight unknowns: (u, v) the velocity of the contact point, the rotation g with
/// w = axial((g - g^T)/2), C = sqrt(1 - |w|^2) the cosine of its angle, and (l1, l2, l3) with nu = (r l1, -r l2, -l3):
///
///     px = u + l2 + h Omega l1 / 2      py = v + l1 - h Omega l2 / 2      M = (tr(g) I - g^T) nu / 2
///     w = (h/r) (Omega xb - v,  u + Omega yb,  r c),    (xb, yb) = (x + h u / 2, y + h v / 2).
///
/// The momentum equation M = [(1 + C) nu + w x nu - w (w.nu) / (1 + C)] / 2 has the closed inverse
///
///     nu(w) = M - w x M / (1 + C) + w (w.M) / (C (1 + C)),
///
/// and with u, v eliminated the constraints read  w1 = a1 + k1 nu1 + k2 nu2,  w2 = a2 + k1 nu2 - k2 nu1,  w3 = h c,
/// with k1 = (h/r^2)(1 - h^2 Omega^2 / 4), k2 = h^2 Omega / r^2: two equations for (w1, w2), solved by Newton's method.
/// Then
///
///     M' = M - w x nu,  px' = px - h Omega l1,  py' = py + h Omega l2,  A' = A g,  g = C I + hat(w) + w w^T / (1 + C).
///
/// The iteration starts from the extrapolated (nu1, nu2) (Degree 0: those of the last step), and ends when the residual
/// is at the round-off of w.
template <int Degree = 0> class PlateBall {
 public:
  PlateBall(const PlateBallParameters& parameters, const PlateBallState& start)
      : h_(parameters.h),
        inverse_radius_(1 / parameters.radius),
        rate_(parameters.plate_rate),
        rolling_(parameters.h / parameters.radius),
        k1_(rolling_ * inverse_radius_ * (1 - 0.25 * h_ * h_ * rate_ * rate_)),
        k2_(rolling_ * inverse_radius_ * h_ * rate_),
        w3_(parameters.h * parameters.spin),
        position_(start.position),
        linear_(start.linear_momentum),
        body_(start.body_momentum),
        attitude_(start.attitude),
        nu_(Eigen::Vector2d(body_.head<2>())) {}

  void step() {
    const double half = 0.5 * h_;
    const Eigen::Vector3d& m = body_;
    const double a1 = rolling_ * (rate_ * (position_(0) + half * linear_(0)) - linear_(1));
    const double a2 = rolling_ * (rate_ * (position_(1) + half * linear_(1)) + linear_(0));
    Eigen::Vector2d nu = nu_.next();
    Eigen::Vector3d w(a1 + k1_ * nu(0) + k2_ * nu(1), a2 + k1_ * nu(1) - k2_ * nu(0), w3_);
    const double tolerance = round_off * (std::abs(a1) + std::abs(a2) + k1_ * (std::abs(nu(0)) + std::abs(nu(1))));
    double cosine = 1;
    double d = 0;
    double e = 0;
    double along = 0;
    Eigen::Vector3d turning;
    for (int iteration = 0;; ++iteration) {
      cosine = std::sqrt(1 - w.squaredNorm());
      e = 1 / (cosine * (1 + cosine));
      d = cosine * e;
      along = w.dot(m);
      turning = w.cross(m);
      const double stretch = along * e;
      nu(0) = m(0) - d * turning(0) + stretch * w(0);
      nu(1) = m(1) - d * turning(1) + stretch * w(1);
      const double r1 = w(0) - a1 - k1_ * nu(0) - k2_ * nu(1);
      const double r2 = w(1) - a2 - k1_ * nu(1) + k2_ * nu(0);
      if ((std::abs(r1) <= tolerance && std::abs(r2) <= tolerance) || iteration == max_iterations) break;
      // d nu_i / d w_j = -d (e_j x M)_i + e (w_i M_j + (w.M) delta_ij) + slope_i w_j, with slope_i w.dw from d and e.
      const double change = along * e * e * e * (1 + cosine) * (1 + 2 * cosine);
      const double slope1 = w(0) * change - cosine * e * e * turning(0);
      const double slope2 = w(1) * change - cosine * e * e * turning(1);
      const double n11 = stretch + e * w(0) * m(0) + slope1 * w(0);
      const double n12 = e * w(0) * m(1) + slope1 * w(1) - d * m(2);
      const double n21 = e * w(1) * m(0) + slope2 * w(0) + d * m(2);
      const double n22 = stretch + e * w(1) * m(1) + slope2 * w(1);
      const double j11 = 1 - k1_ * n11 - k2_ * n21;
      const double j12 = -k1_ * n12 - k2_ * n22;
      const double j21 = k2_ * n11 - k1_ * n21;
      const double j22 = 1 + k2_ * n12 - k1_ * n22;
      const double scale = 1 / (j11 * j22 - j12 * j21);
      w(0) -= scale * (j22 * r1 - j12 * r2);
      w(1) -= scale * (j11 * r2 - j21 * r1);
    }
    nu_.record(nu);
    const Eigen::Vector3d full(nu(0), nu(1), m(2) - d * turning(2) + along * e * w(2));
    const double l1 = full(0) * inverse_radius_;
    const double l2 = -full(1) * inverse_radius_;
    multipliers_ << l1, l2, -full(2);
    position_(0) += h_ * (linear_(0) - l2 - half * rate_ * l1);
    position_(1) += h_ * (linear_(1) - l1 + half * rate_ * l2);
    linear_(0) -= h_ * rate_ * l1;
    linear_(1) += h_ * rate_ * l2;
    body_ -= w.cross(full);
    Eigen::Matrix3d g;
    const Eigen::Vector3d z = d * w;
    g << cosine + z(0) * w(0), z(0) * w(1) - w(2), z(0) * w(2) + w(1),  //
        z(0) * w(1) + w(2), cosine + z(1) * w(1), z(1) * w(2) - w(0),   //
        z(0) * w(2) - w(1), z(1) * w(2) + w(0), cosine + z(2) * w(2);
    attitude_.turn(g);
  }

  const Eigen::Vector2d& position() const { return position_; }
  const Eigen::Vector2d& linear_momentum() const { return linear_; }
  const Eigen::Vector3d& body_momentum() const { return body_; }
  Eigen::Matrix3d attitude() const { return attitude_.matrix(); }
  /// (l1, l2, l3) of the last step.
  const Eigen::Vector3d& multipliers() const { return multipliers_; }

 private:
  static constexpr int max_iterations = 20;
  static constexpr double round_off = 2 * std::numeric_limits<double>::epsilon();

  double h_;
  double inverse_radius_;
  double rate_;
  double rolling_;  // h / r
  double k1_;
  double k2_;
  double w3_;
  Eigen::Vector2d position_;
  Eigen::Vector2d linear_;
  Eigen::Vector3d body_;
  Attitude attitude_;
  Extrapolation<2, Degree> nu_;
  Eigen::Vector3d multipliers_ = Eigen::Vector3d::Zero();
};

}  // namespace kernels
