#pragma once
/// The free rigid body with the Cayley map, by hand.

#include "attitude.hpp"
#include "extrapolation.hpp"

#include <Eigen/Geometry>

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
        inertia_(inertia),
        velocity_(h * inertia.cwiseInverse()),
        tolerance_(2 * std::numeric_limits<double>::epsilon() * h * momentum.norm()),
        momentum_(momentum),
        attitude_(attitude) {}

  void step() {
    const Eigen::Vector3d explicit_part = velocity_.cwiseProduct(momentum_);
    const Eigen::Vector3d right = h_ * momentum_;
    Eigen::Vector3d x = explicit_part + correction_.next();
    Eigen::Vector3d turning;
    for (int iteration = 0;; ++iteration) {
      const Eigen::Vector3d p = inertia_.cwiseProduct(x);
      const double quarter = 0.25 * x.dot(p);
      turning = x.cross(p);
      const Eigen::Vector3d residual = p + 0.5 * turning + quarter * x - right;
      if (residual.lpNorm<Eigen::Infinity>() <= tolerance_ || iteration == max_iterations) break;
      // J = diag(I) + (hat(x) diag(I) - hat(p)) / 2 + (x.p) / 4 + x p^T / 2, solved by Cramer's rule.
      const Eigen::Vector3d y = 0.5 * x;
      const Eigen::Vector3d s = 0.5 * p;
      const auto& i = inertia_;
      const Eigen::Vector3d a(i(0) + quarter + y(0) * p(0), y(2) * i(0) - s(2) + y(1) * p(0),
                              s(1) - y(1) * i(0) + y(2) * p(0));
      const Eigen::Vector3d b(s(2) - y(2) * i(1) + y(0) * p(1), i(1) + quarter + y(1) * p(1),
                              y(0) * i(1) - s(0) + y(2) * p(1));
      const Eigen::Vector3d c(y(1) * i(2) - s(1) + y(0) * p(2), s(0) - y(0) * i(2) + y(1) * p(2),
                              i(2) + quarter + y(2) * p(2));
      const Eigen::Vector3d bc = b.cross(c);
      const double scale = 1 / a.dot(bc);
      x -= scale * Eigen::Vector3d(residual.dot(bc), residual.dot(c.cross(a)), residual.dot(a.cross(b)));
    }
    correction_.record(x - explicit_part);
    solution_ = x;
    momentum_ -= turning / h_;
    attitude_.turn(cayley(x));
  }

  const Eigen::Vector3d& momentum() const { return momentum_; }
  Eigen::Matrix3d attitude() const { return attitude_.matrix(); }
  /// x of the last step.
  const Eigen::Vector3d& solution() const { return solution_; }

  static Eigen::Matrix3d cayley(const Eigen::Vector3d& x) {
    const double scale = 1 / (1 + 0.25 * x.squaredNorm());
    const Eigen::Vector3d y = scale * x;
    const Eigen::Vector3d z = 0.5 * y;
    Eigen::Matrix3d g;
    g << 1 - z(1) * x(1) - z(2) * x(2), z(0) * x(1) - y(2), z(0) * x(2) + y(1),  //
        z(0) * x(1) + y(2), 1 - z(0) * x(0) - z(2) * x(2), z(1) * x(2) - y(0),   //
        z(0) * x(2) - y(1), z(1) * x(2) + y(0), 1 - z(0) * x(0) - z(1) * x(1);
    return g;
  }

 private:
  static constexpr int max_iterations = 20;

  double h_;
  Eigen::Vector3d inertia_;
  Eigen::Vector3d velocity_;  // h I^{-1}
  double tolerance_;
  Eigen::Vector3d momentum_;
  Attitude attitude_;
  Extrapolation<3, Degree> correction_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d solution_ = Eigen::Vector3d::Zero();
};

}  // namespace kernels
