#pragma once
/// The initial-value problem of the plate-ball system in the trace form, by Newton's method on all eight unknowns.

#include "attitude.hpp"
#include "extrapolation.hpp"
#include "plate_ball.hpp"

#include <cmath>
#include <limits>

namespace kernels {

/// The step of `PlateBall`, without its closed inverse of the momentum equation: Newton's method on the unknowns of the
/// framework, (u, v, theta, l1, l2, l3) with g <- g cay(theta), its linear equations eliminated by hand. The residuals
/// are, in the notation of `PlateBall`, with K = (tr(g) I - g^T) / 2 and sigma = h Omega / 2,
///
///     u + l2 + sigma l1 - px,   v + l1 - sigma l2 - py,   R = K nu - M,
///     phi1 = h v + r w1 - h Omega xb,   phi2 = h u - r w2 + h Omega yb,   phi3 = h c - w3.
///
/// Along g cay(theta) w changes by K theta and K nu by -(nu w^T + hat(b) / 2) theta, b = g^T nu. The first two equations
/// are linear and hold at every iterate: they give u and v. What they leave of the constraints is
///
///     s = w - a - kappa nu = (phi1, -phi2, -phi3) / (r, r, 1),   kappa = ( k1 k2 0 ; -k2 k1 0 ; 0 0 0 ),   a3 = h c,
///
/// so that K theta = kappa dnu - s. The inverse of K is Y / D with the polynomials D = C (1 + C) = 2 det K and
/// Y = D I - C hat(w) + w w^T, for which w^T Y = (1 + C) w^T. That eliminates theta:
///
///     (2 D K - T kappa) dnu = -2 D R - T s,   T = 2 (1 + C) nu w^T + hat(b) Y,
///
/// three equations, solved by Cramer's rule: dnu = n / E. With z = Y (kappa n - E s) and e = E D then theta = z / e, and
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
      const double trace = g.x.x + g.y.y + g.z.z;
      const Triple b(dot(g.x, nu), dot(g.y, nu), dot(g.z, nu));
      w = {0.5 * (g.y.z - g.z.y), 0.5 * (g.z.x - g.x.z), 0.5 * (g.x.y - g.y.x)};
      cosine = 0.5 * (trace - 1);
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
      const Triple twice = (2 + 2 * cosine) * nu;
      const Triple t1 = w.x * twice + cross(b, y.x);
      const Triple t2 = w.y * twice + cross(b, y.y);
      const Triple t3 = w.z * twice + cross(b, y.z);
      const Triple m1 = Triple(d * (trace - g.x.x), -d * g.y.x, -d * g.z.x) - k1_ * t1 + k2_ * t2;
      const Triple m2 = Triple(-d * g.x.y, d * (trace - g.y.y), -d * g.z.y) - k2_ * t1 - k1_ * t2;
      const Triple m3(-d * g.x.z, -d * g.y.z, d * (trace - g.z.z));
      const Triple right = (-2 * d) * r - s.x * t1 - s.y * t2 - s.z * t3;
      const Triple m23 = cross(m2, m3);
      const double determinant = dot(m1, m23);
      const Triple n(dot(right, m23), dot(right, cross(m3, m1)), dot(right, cross(m1, m2)));
      nu = nu + (1 / determinant) * n;

      const Triple change = kappa(n) - determinant * s;
      const Triple z = change.x * y.x + change.y * y.y + change.z * y.z;
      g = turned(g, z, determinant * d);
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
    const double square = 0.25 * dot(z, z);
    const double scale = 1 / (e * e + square);
    const double half = 0.5 * scale;
    const Triple odd = (scale * e) * z;
    const Triple even = half * z;
    const double xx = -even.y * z.y - even.z * z.z;
    const double yy = -even.x * z.x - even.z * z.z;
    const double zz = -even.x * z.x - even.y * z.y;
    const double xy = even.x * z.y;
    const double yz = even.y * z.z;
    const double zx = even.z * z.x;
    return {g.x + xx * g.x + (xy + odd.z) * g.y + (zx - odd.y) * g.z,
            g.y + (xy - odd.z) * g.x + yy * g.y + (yz + odd.x) * g.z,
            g.z + (zx + odd.y) * g.x + (yz - odd.x) * g.y + zz * g.z};
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
