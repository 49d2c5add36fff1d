#pragma once
/// The free rigid body with the Cayley map, by hand.

#include "attitude.hpp"
#include "extrapolation.hpp"

#include <cmath>
#include <limits>

namespace kernels {

/// L(g) = x.I x / (2 h), g = cay(x) = I + (hat(x) + hat(x)^2 / 2) / (1 + |x|^2 / 4). With p = I x the discrete Legendre
/// transforms are
///
///     h F-(x) = p + x x p / 2 + (x.p) x / 4          h F+(x) = p - x x p / 2 + (x.p) x / 4
///
/// so that a step solves the polynomial equation h F-(x) = h M for x and then M' = M - x x p / h, A' = A cay(x).
///
/// Newton's method starts from h I^{-1} M plus the extrapolated difference of x from it (Degree 0: the last step's),
/// and ends when the residual is at the round-off of its terms.
template <int Degree = 0> class So3Cayley {
 public:
  So3Cayley(double h, const Eigen::Vector3d& inertia, const Eigen::Vector3d& momentum, const Eigen::Matrix3d& attitude)
      : h_(h),
        rate_(1 / h),
        inertia_(inertia),
        inverse_(Eigen::Vector3d(h * inertia.cwiseInverse())),
        tolerance_(2 * std::numeric_limits<double>::epsilon() * h * momentum.norm()),
        momentum_(momentum),
        attitude_(attitude) {}

  void step() {
    const Triple& i = inertia_;
    const Triple right = h_ * momentum_;
    const Triple explicit_part = scaled(inverse_, momentum_);
    Triple x = explicit_part + correction_.next();
    Triple turning;
    for (int iteration = 0;; ++iteration) {
      const Triple p = scaled(i, x);
      const double quarter = 0.25 * dot(x, p);
      turning = cross(x, p);
      const Triple residual = p + 0.5 * turning + quarter * x - right;
      if (solved(residual) || iteration == max_iterations) break;
      // J = diag(I) + (hat(x) diag(I) - hat(p)) / 2 + (x.p) / 4 + x p^T / 2 = (a b c), by Cramer's rule.
      const Triple y = 0.5 * x;
      const Triple s = 0.5 * p;
      const Triple a(i.x + quarter + y.x * p.x, y.z * i.x - s.z + y.y * p.x, s.y - y.y * i.x + y.z * p.x);
      const Triple b(s.z - y.z * i.y + y.x * p.y, i.y + quarter + y.y * p.y, y.x * i.y - s.x + y.z * p.y);
      const Triple c(y.y * i.z - s.y + y.x * p.z, s.x - y.x * i.z + y.y * p.z, i.z + quarter + y.z * p.z);
      const Triple bc = cross(b, c);
      x = x - (1 / dot(a, bc)) * Triple(dot(residual, bc), dot(residual, cross(c, a)), dot(residual, cross(a, b)));
    }
    correction_.record(x - explicit_part);
    solution_ = x;
    momentum_ = momentum_ - rate_ * turning;
    // cay(x) = c I + hat(y) + d y y^T with y = x / (1 + |x|^2/4), c = 2 / (1 + |x|^2/4) - 1, d = (1 + |x|^2/4) / 2.
    const double stretch = 1 + 0.25 * dot(x, x);
    const double scale = 1 / stretch;
    attitude_.turn(scale * x, 2 * scale - 1, 0.5 * stretch);
  }

  Eigen::Vector3d momentum() const { return momentum_.vector(); }
  Eigen::Matrix3d attitude() const { return attitude_.matrix(); }
  /// x of the last step.
  Eigen::Vector3d solution() const { return solution_.vector(); }

 private:
  static constexpr int max_iterations = 20;

  bool solved(Triple r) const {
    return std::abs(r.x) <= tolerance_ && std::abs(r.y) <= tolerance_ && std::abs(r.z) <= tolerance_;
  }

  double h_;
  double rate_;
  Triple inertia_;
  Triple inverse_;  // h I^{-1}
  double tolerance_;
  Triple momentum_;
  Attitude attitude_;
  Extrapolation<Triple, Degree> correction_;
  Triple solution_;
};

}  // namespace kernels
