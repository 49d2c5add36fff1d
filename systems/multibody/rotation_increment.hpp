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
template <class S = double> struct BasicRotationIncrement {
  Vector<S, 3> inertia_over_h;  ///< principal moments over the step, kg m^2 / s
  Retraction map = Retraction::cayley;

  /// F-(xi): the body angular momentum that this turn begins with.
  Vector<S, 3> momentum(const Vector<S, 3>& xi) const {
    const Vector<S, 3> pi = inertia_over_h.cwiseProduct(xi);
    const Vector<S, 3> twisted = pi + 0.5 * xi.cross(pi);
    const S along = xi.dot(pi);
    if (map == Retraction::cayley) return twisted + (0.25 * along) * xi;
    const S x = xi.squaredNorm();
    return twisted + bend(x) * (along * xi - x * pi);
  }

  /// dF-/dxi.
  Matrix<S, 3, 3> derivative(const Vector<S, 3>& xi) const {
    const Vector<S, 3> pi = inertia_over_h.cwiseProduct(xi);
    const S along = xi.dot(pi);
    Matrix<S, 3, 3> a = 0.5 * (SO3::hat(xi) * inertia_over_h.asDiagonal() - SO3::hat(pi));
    a.diagonal() += inertia_over_h;
    if (map == Retraction::cayley) {
      a += 0.5 * xi * pi.transpose();
      a.diagonal().array() += 0.25 * along;
      return a;
    }
    const S x = xi.squaredNorm();
    const S d = bend(x);
    a += (2 * d) * (xi * pi.transpose() - pi * xi.transpose());
    a.diagonal() += d * (Vector<S, 3>::Constant(along) - x * inertia_over_h);
    a += (2 * bend_rate(x)) * (along * xi - x * pi) * xi.transpose();
    return a;
  }

  /// The left-trivialised differential of tau at xi: tau(xi + e) = tau(xi) tau(T e) to first order.
  Matrix<S, 3, 3> target_frame(const Vector<S, 3>& xi) const {
    const S x = xi.squaredNorm();
    if (map == Retraction::exponential) return SO3::dexp(xi);
    Matrix<S, 3, 3> t = SO3::hat(Vector<S, 3>(-0.5 * xi));
    t.diagonal().array() += 1;
    return t / (1 + 0.25 * x);
  }

  /// tau(xi)^T m - m.
  Vector<S, 3> carried_change(const Vector<S, 3>& xi, const Vector<S, 3>& m) const {
    const Vector<S, 3> across = xi.cross(m);
    const S x = xi.squaredNorm();
    if (map == Retraction::exponential) return stumpff<2>(x) * xi.cross(across) - stumpff<1>(x) * across;
    const S s = 1 / (1 + 0.25 * x);
    return (0.5 * s) * xi.cross(across) - s * across;
  }

  /// The unit quaternion of tau(xi).
  Vector<S, 4> quaternion(const Vector<S, 3>& xi) const {
    const S x = 0.25 * xi.squaredNorm();
    if (map == Retraction::exponential) {
      const S s = 0.5 * stumpff<1>(x);
      return {stumpff<0>(x), s * xi(0), s * xi(1), s * xi(2)};
    }
    using std::sqrt;
    const S w = 1 / sqrt(1 + x);
    const S s = 0.5 * w;
    return {w, s * xi(0), s * xi(1), s * xi(2)};
  }

  /// Largest |xi|: below it, tau is one to one (infinite for Cayley).
  static constexpr double limit = 6.2;

 private:
  /// (1 - (a/2) cot(a/2)) / a^2, x = a^2, and its derivative in x.
  static S bend(const S& x) { return (stumpff<3>(x) - 2 * stumpff<4>(x)) / (2 * stumpff<2>(x)); }
  static S bend_rate(const S& x) {
    const S above = stumpff<3>(x) - 2 * stumpff<4>(x);
    const S below = 2 * stumpff<2>(x);
    const S above_rate = stumpff_derivative<3>(x) - 2 * stumpff_derivative<4>(x);
    return (above_rate - above / below * 2 * stumpff_derivative<2>(x)) / below;
  }
};
using RotationIncrement = BasicRotationIncrement<>;

}  // namespace lagroid::multibody
