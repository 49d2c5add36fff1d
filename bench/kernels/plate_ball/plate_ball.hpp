#pragma once
/// The initial-value problem of the plate-ball system in the trace form, by hand.

#include "../attitude.hpp"
#include "../extrapolation.hpp"

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
        nu_(Pair(body_.x, body_.y)) {}

  void step() {
    const double half = 0.5 * h_;
    const Triple m = body_;
    const double a1 = rolling_ * (rate_ * (position_.x + half * linear_.x) - linear_.y);
    const double a2 = rolling_ * (rate_ * (position_.y + half * linear_.y) + linear_.x);
    Pair nu = nu_.next();
    Triple w(a1 + k1_ * nu.x + k2_ * nu.y, a2 + k1_ * nu.y - k2_ * nu.x, w3_);
    const double tolerance = round_off * (std::abs(a1) + std::abs(a2) + k1_ * (std::abs(nu.x) + std::abs(nu.y)));
    double cosine = 1;
    double d = 0;        // 1 / (1 + C)
    double stretch = 0;  // (w.M) / (C (1 + C))
    Triple turning;      // w x M
    for (int iteration = 0;; ++iteration) {
      cosine = std::sqrt(1 - dot(w, w));
      const double e = 1 / (cosine * (1 + cosine));
      d = cosine * e;
      stretch = e * dot(w, m);
      turning = cross(w, m);
      nu = {m.x - d * turning.x + stretch * w.x, m.y - d * turning.y + stretch * w.y};
      const double r1 = w.x - a1 - k1_ * nu.x - k2_ * nu.y;
      const double r2 = w.y - a2 - k1_ * nu.y + k2_ * nu.x;
      if ((std::abs(r1) <= tolerance && std::abs(r2) <= tolerance) || iteration == max_iterations) break;
      // d nu_i / d w_j = -d (e_j x M)_i + e w_i M_j + stretch delta_ij + slope_i w_j, the slope from those of d and e.
      const double change = stretch * e * e * (1 + cosine) * (1 + 2 * cosine);
      const double slope1 = w.x * change - cosine * e * e * turning.x;
      const double slope2 = w.y * change - cosine * e * e * turning.y;
      const double n11 = stretch + e * w.x * m.x + slope1 * w.x;
      const double n12 = e * w.x * m.y + slope1 * w.y - d * m.z;
      const double n21 = e * w.y * m.x + slope2 * w.x + d * m.z;
      const double n22 = stretch + e * w.y * m.y + slope2 * w.y;
      const double j11 = 1 - k1_ * n11 - k2_ * n21;
      const double j12 = -k1_ * n12 - k2_ * n22;
      const double j21 = k2_ * n11 - k1_ * n21;
      const double j22 = 1 + k2_ * n12 - k1_ * n22;
      const double scale = 1 / (j11 * j22 - j12 * j21);
      w.x -= scale * (j22 * r1 - j12 * r2);
      w.y -= scale * (j11 * r2 - j21 * r1);
    }
    nu_.record(nu);
    const Triple full(nu.x, nu.y, m.z - d * turning.z + stretch * w.z);
    multipliers_ = {inverse_radius_ * full.x, -inverse_radius_ * full.y, -full.z};
    const double tilt1 = rate_ * multipliers_.x;
    const double tilt2 = rate_ * multipliers_.y;
    position_ =
        position_ + h_ * Pair(linear_.x - multipliers_.y - half * tilt1, linear_.y - multipliers_.x + half * tilt2);
    linear_ = linear_ + h_ * Pair(-tilt1, tilt2);
    body_ = m - cross(w, full);
    attitude_.turn(w, cosine, d);
  }

  Eigen::Vector2d position() const { return position_.vector(); }
  Eigen::Vector2d linear_momentum() const { return linear_.vector(); }
  Eigen::Vector3d body_momentum() const { return body_.vector(); }
  Eigen::Matrix3d attitude() const { return attitude_.matrix(); }
  /// (l1, l2, l3) of the last step.
  Eigen::Vector3d multipliers() const { return multipliers_.vector(); }

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
  Pair position_;
  Pair linear_;
  Triple body_;
  Attitude attitude_;
  Extrapolation<Pair, Degree> nu_;
  Triple multipliers_;
};

}  // namespace kernels
