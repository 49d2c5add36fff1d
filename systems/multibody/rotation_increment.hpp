#pragma once
/// The rotation of one body in one step, in coordinates xi, g = tau(xi):
///
///     F-(xi) = (dtau^{-1}_{-xi})^T I xi / h,    F+ = g^T F-.
///
/// A detail of the steps of scenes, with derivative, quaternion and frames in closed form. Requires |xi| below `limit`
/// where tau is the exponential. [G] 6.1

#include <lagroid/core/scalars/special_functions.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/systems/multibody/configuration.hpp>

#include <cmath>

namespace lagroid::multibody {

/// Quaternions (w, x, y, z) of attitudes.
using Quaternion = Vector<double, 4>;

inline Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a(0) * b(0) - a(1) * b(1) - a(2) * b(2) - a(3) * b(3), a(0) * b(1) + a(1) * b(0) + a(2) * b(3) - a(3) * b(2),
          a(0) * b(2) + a(2) * b(0) + a(3) * b(1) - a(1) * b(3), a(0) * b(3) + a(3) * b(0) + a(1) * b(2) - a(2) * b(1)};
}

/// The discrete Legendre transforms of h l(tau^{-1}(g) / h), l(w) = w.I w / 2, at g = tau(xi), in the coordinates xi:
/// F-(xi) = (dtau^{-1}_{-xi})^T Pi with Pi = I xi / h, F+ = g^T F-. [G] 6.1
struct RotationIncrement {
  Vec inertia_over_h;  ///< principal moments over the step, kg m^2 / s
  Retraction map = Retraction::cayley;

  /// F-(xi): the body angular momentum that this turn begins with.
  Vec momentum(const Vec& xi) const {
    const Vec pi = inertia_over_h.cwiseProduct(xi);
    const Vec twisted = pi + 0.5 * xi.cross(pi);
    const double along = xi.dot(pi);
    if (map == Retraction::cayley) return twisted + (0.25 * along) * xi;
    const double x = xi.squaredNorm();
    return twisted + bend(x) * (along * xi - x * pi);
  }

  /// dF-/dxi.
  Mat derivative(const Vec& xi) const {
    const Vec pi = inertia_over_h.cwiseProduct(xi);
    const double along = xi.dot(pi);
    Mat a = 0.5 * (SO3::hat(xi) * inertia_over_h.asDiagonal() - SO3::hat(pi));
    a.diagonal() += inertia_over_h;
    if (map == Retraction::cayley) {
      a += 0.5 * xi * pi.transpose();
      a.diagonal().array() += 0.25 * along;
      return a;
    }
    const double x = xi.squaredNorm();
    const double d = bend(x);
    a += (2 * d) * (xi * pi.transpose() - pi * xi.transpose());
    a.diagonal() += d * (Vec::Constant(along) - x * inertia_over_h);
    a += (2 * bend_rate(x)) * (along * xi - x * pi) * xi.transpose();
    return a;
  }

  /// The left-trivialised differential of tau at xi: tau(xi + e) = tau(xi) tau(T e) to first order.
  Mat target_frame(const Vec& xi) const {
    const double x = xi.squaredNorm();
    if (map == Retraction::exponential) return SO3::dexp(xi);
    Mat t = SO3::hat(Vec(-0.5 * xi));
    t.diagonal().array() += 1;
    return t / (1 + 0.25 * x);
  }

  /// tau(xi)^T m - m.
  Vec carried_change(const Vec& xi, const Vec& m) const {
    const Vec across = xi.cross(m);
    const double x = xi.squaredNorm();
    if (map == Retraction::exponential) return stumpff<2>(x) * xi.cross(across) - stumpff<1>(x) * across;
    const double s = 1 / (1 + 0.25 * x);
    return (0.5 * s) * xi.cross(across) - s * across;
  }

  /// The unit quaternion of tau(xi).
  Quaternion quaternion(const Vec& xi) const {
    const double x = 0.25 * xi.squaredNorm();
    if (map == Retraction::exponential) {
      const double s = 0.5 * stumpff<1>(x);
      return {stumpff<0>(x), s * xi(0), s * xi(1), s * xi(2)};
    }
    const double w = 1 / std::sqrt(1 + x);
    const double s = 0.5 * w;
    return {w, s * xi(0), s * xi(1), s * xi(2)};
  }

  /// Largest |xi|: below it, tau is one to one (infinite for Cayley).
  static constexpr double limit = 6.2;

 private:
  /// (1 - (a/2) cot(a/2)) / a^2, x = a^2, and its derivative in x.
  static double bend(double x) { return (stumpff<3>(x) - 2 * stumpff<4>(x)) / (2 * stumpff<2>(x)); }
  static double bend_rate(double x) {
    const double above = stumpff<3>(x) - 2 * stumpff<4>(x);
    const double below = 2 * stumpff<2>(x);
    const double above_rate = stumpff_derivative<3>(x) - 2 * stumpff_derivative<4>(x);
    return (above_rate - above / below * 2 * stumpff_derivative<2>(x)) / below;
  }
};

}  // namespace lagroid::multibody
