#pragma once
/// The initial-value problem of the plate-ball system in the trace form, by Newton's method on all eight unknowns.

#include "../attitude.hpp"
#include "../extrapolation.hpp"
#include "plate_ball.hpp"

#include <cmath>
#include <limits>

namespace kernels {

/// The step of `PlateBall` without its closed inverse of the momentum equation: Newton's method on the unknowns of the
/// framework, (u, v, theta, l1, l2, l3) with g <- g cay(theta), its linear equations solved by elimination by hand. The
/// equations are, in the notation of `PlateBall`, with K = (tr(g) I - g^T) / 2 and sigma = h Omega / 2,
///
///     u + l2 + sigma l1 - px = 0      v + l1 - sigma l2 - py = 0      R = K nu - M = 0
///     phi1 = h v + r w1 - h Omega xb = 0      phi2 = h u - r w2 + h Omega yb = 0      phi3 = h c - w3 = 0.
///
/// The first two are linear, so that they hold at every iterate and give u and v. What they leave of the constraints is
///
///     s = w - a - kappa nu = (phi1 / r, -phi2 / r, -phi3),   kappa = ( k1 k2 0 ; -k2 k1 0 ; 0 0 0 ),   a3 = h c.
///
/// Along g cay(theta) w changes by K theta, and K at fixed nu by -(nu w^T + hat(b) / 2) theta with b = g^T nu:
///
///     K theta = kappa dnu - s,      K dnu - (nu w^T + hat(b) / 2) theta = -R.
///
/// With the polynomials D = C (1 + C) and Y = D I - C hat(w) + w w^T, K^{-1} = Y / D and w^T Y = (1 + C) w^T. Hence
///
///     (2 D K - T kappa) dnu = -2 D R - T s,      T = 2 (1 + C) nu w^T + hat(b) Y,
///
/// three equations, solved by Cramer's rule: dnu = n / E. Then theta = z / e with z = Y (kappa n - E s), e = E D, and
/// cay(theta) = I + (e hat(z) + hat(z)^2 / 2) / (e^2 + |z|^2 / 4).
///
/// The iteration starts from the extrapolated nu (Degree 0: that of the last step) and the w that solves the
/// constraints with it, and ends when R and s are at their round-off. The state is updated as in `PlateBall`.
template <int Degree = 0> class PlateBallNewton {
 public:
  PlateBallNewton(const PlateBallParameters& parameters, const PlateBallState& start)
      : h_(parameters.h),
        inverse_radius_(1 / parameters.radius),
        rate_(parameters.plate_rate),
        rolling_(parameters.h / parameters.radius),
        k1_(rolling_ * inverse_radius_ * (1 - 0.25 * h_ * h_ * rate_ * rate_)),
        k2_(rolling_ * inverse_radius_ * h_ * rate_),
        w3_(parameters.h * parameters.spin),
        momentum_tolerance_(round_off * start.body_momentum.norm()),
        position_(start.position),
        linear_(start.linear_momentum),
        body_(start.body_momentum),
        attitude_(start.attitude),
        nu_(body_) {}

  void step() {
    const double half = 0.5 * h_;
    const Triple a(rolling_ * (rate_ * (position_.x + half * linear_.x) - linear_.y),
                   rolling_ * (rate_ * (position_.y + half * linear_.y) + linear_.x), w3_);
    Triple nu = nu_.next();
    Triple w = a + kappa(nu);
    const double tolerance =
        round_off * (std::abs(a.x) + std::abs(a.y) + std::abs(a.z) + k1_ * (std::abs(nu.x) + std::abs(nu.y)));
    double cosine = std::sqrt(1 - dot(w, w));
    Columns g = rotation(w, cosine);
    for (int iteration = 0;; ++iteration) {
      const double trace = 1 + 2 * cosine;
      const Triple b(dot(g.x, nu), dot(g.y, nu), dot(g.z, nu));
      const Triple r = 0.5 * (trace * nu - b) - body_;
      const Triple s = w - a - kappa(nu);
      if ((within(r, momentum_tolerance_) && within(s, tolerance)) || iteration == max_iterations) break;

      const double d = cosine + cosine * cosine;
      const Triple q = cosine * w;
      const double xy = w.x * w.y;
      const double yz = w.y * w.z;
      const double zx = w.z * w.x;
      const Columns y{{d + w.x * w.x, xy - q.z, zx + q.y},
                      {xy + q.z, d + w.y * w.y, yz - q.x},
                      {zx - q.y, yz + q.x, d + w.z * w.z}};
      const Triple y1 = k1_ * y.x - k2_ * y.y;
      const Triple y2 = k2_ * y.x + k1_ * y.y;
      const Triple ys = s.x * y.x + s.y * y.y + s.z * y.z;
      const Triple twice = (2 + 2 * cosine) * nu;
      const Triple m1 =
          Triple(d * (trace - g.x.x), -d * g.y.x, -d * g.z.x) - (k1_ * w.x - k2_ * w.y) * twice - cross(b, y1);
      const Triple m2 =
          Triple(-d * g.x.y, d * (trace - g.y.y), -d * g.z.y) - (k2_ * w.x + k1_ * w.y) * twice - cross(b, y2);
      const Triple m3(-d * g.x.z, -d * g.y.z, d * (trace - g.z.z));
      const Triple right = (-2 * d) * r - dot(w, s) * twice - cross(b, ys);
      const Triple m23 = cross(m2, m3);
      const double determinant = dot(m1, m23);
      const Triple n(dot(right, m23), dot(right, cross(m3, m1)), dot(right, cross(m1, m2)));
      nu = nu + (1 / determinant) * n;

      const Triple z = n.x * y1 + n.y * y2 - determinant * ys;
      g = turned(g, z, determinant * d);
      w = {0.5 * (g.y.z - g.z.y), 0.5 * (g.z.x - g.x.z), 0.5 * (g.x.y - g.y.x)};
      cosine = 0.5 * (g.x.x + g.y.y + g.z.z - 1);
    }
    nu_.record(nu);
    multipliers_ = {inverse_radius_ * nu.x, -inverse_radius_ * nu.y, -nu.z};
    const double tilt1 = rate_ * multipliers_.x;
    const double tilt2 = rate_ * multipliers_.y;
    position_ =
        position_ + h_ * Pair(linear_.x - multipliers_.y - half * tilt1, linear_.y - multipliers_.x + half * tilt2);
    linear_ = linear_ + h_ * Pair(-tilt1, tilt2);
    body_ = body_ - cross(w, nu);
    attitude_.turn(w, cosine, 1 / (1 + cosine));
  }

  Eigen::Vector2d position() const { return position_.vector(); }
  Eigen::Vector2d linear_momentum() const { return linear_.vector(); }
  Eigen::Vector3d body_momentum() const { return body_.vector(); }
  Eigen::Matrix3d attitude() const { return attitude_.matrix(); }
  /// (l1, l2, l3) of the last step.
  Eigen::Vector3d multipliers() const { return multipliers_.vector(); }

 private:
  struct Columns {
    Triple x;
    Triple y;
    Triple z;
  };

  static constexpr int max_iterations = 20;
  static constexpr double round_off = 2 * std::numeric_limits<double>::epsilon();

  static bool within(Triple r, double bound) {
    return std::abs(r.x) <= bound && std::abs(r.y) <= bound && std::abs(r.z) <= bound;
  }

  Triple kappa(Triple nu) const { return {k1_ * nu.x + k2_ * nu.y, k1_ * nu.y - k2_ * nu.x, 0}; }

  /// c I + hat(w) + w w^T / (1 + c).
  static Columns rotation(Triple w, double c) {
    const Triple z = (1 / (1 + c)) * w;
    return {{c + z.x * w.x, z.x * w.y + w.z, z.x * w.z - w.y},
            {z.x * w.y - w.z, c + z.y * w.y, z.y * w.z + w.x},
            {z.x * w.z + w.y, z.y * w.z - w.x, c + z.z * w.z}};
  }

  /// g cay(z / e).
  static Columns turned(const Columns& g, Triple z, double e) {
    const double scale = 1 / (e * e + 0.25 * dot(z, z));
    const Triple odd = e * z;
    const Triple even = 0.5 * z;
    const double xx = even.x * z.x;
    const double yy = even.y * z.y;
    const double zz = even.z * z.z;
    const double xy = even.x * z.y;
    const double yz = even.y * z.z;
    const double zx = even.z * z.x;
    return {g.x + scale * ((xy + odd.z) * g.y + (zx - odd.y) * g.z - (yy + zz) * g.x),
            g.y + scale * ((xy - odd.z) * g.x + (yz + odd.x) * g.z - (xx + zz) * g.y),
            g.z + scale * ((zx + odd.y) * g.x + (yz - odd.x) * g.y - (xx + yy) * g.z)};
  }

  double h_;
  double inverse_radius_;
  double rate_;
  double rolling_;  // h / r
  double k1_;
  double k2_;
  double w3_;
  double momentum_tolerance_;
  Pair position_;
  Pair linear_;
  Triple body_;
  Attitude attitude_;
  Extrapolation<Triple, Degree> nu_;
  Triple multipliers_;
};

}  // namespace kernels
