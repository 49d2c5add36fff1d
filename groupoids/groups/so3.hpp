#pragma once
/// SO(3), the rotations of space: exp(w) = I + c_1(|w|^2) hat(w) + c_2(|w|^2) hat(w)^2 turns by |w| about w.
///
/// Attitudes of rigid bodies without the singularities of angles, and without the sign of quaternions.
///
///     const Matrix<double, 3, 3> g = SO3::exp(Vector<double, 3>(0.1, 0, 0));
///     const Vector<double, 3> w = SO3::log(g);
///     const Vector<double, 4> quaternion = SO3::quaternion(g);  // (w, x, y, z), w >= 0
///
/// `log` returns a vector of norm at most pi, accurate at every angle; `cayley_inverse` requires an angle below pi.
/// Nothing throws.

#include <lagroid/groupoids/groups/matrix_group.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <numbers>

namespace lagroid {

/// Arrows: 3 x 3 rotation matrices R. Algebra: xi = w in R^3, hat(w) u = w x u, ad_w = hat(w).
/// A chain g1 g2 ... of arrows is body-fixed: A_k = A_{k-1} g_k, and log(g)/h is a body angular velocity.
/// Memory: column-major matrix.
template <Retraction Tau = Retraction::exponential>
struct SpecialOrthogonal3 : MatrixGroup<SpecialOrthogonal3<Tau>, 3, 3, Tau> {
  template <class S> static Matrix<S, 3, 3> hat(const Vector<S, 3>& w) {
    Matrix<S, 3, 3> x;
    x(0, 0) = x(1, 1) = x(2, 2) = S(0);
    x(1, 0) = w(2);
    x(2, 0) = -w(1);
    x(2, 1) = w(0);
    x(0, 1) = -w(2);
    x(0, 2) = w(1);
    x(1, 2) = -w(0);
    return x;
  }
  static constexpr int basis(int i, int r, int c) { return (r - c) * (c - i) * (r - i) / 2; }
  /// The axial vector of the antisymmetric part.
  template <class S> static Vector<S, 3> vee(const Matrix<S, 3, 3>& x) {
    return Vector<S, 3>((x(2, 1) - x(1, 2)) * 0.5, (x(0, 2) - x(2, 0)) * 0.5, (x(1, 0) - x(0, 1)) * 0.5);
  }
  template <class S> static Matrix<S, 3, 3> inverse(const Matrix<S, 3, 3>& g) {
    Matrix<S, 3, 3> out;
    unrolled<3>([&]<int R>() { unrolled<3>([&]<int C>() { out(R, C) = g(C, R); }); });
    return out;
  }
  /// Rodrigues: I + c_1(|w|^2) hat(w) + c_2(|w|^2) hat(w)^2.
  template <class S> static Matrix<S, 3, 3> exp(const Vector<S, 3>& w) {
    const S xx = w(0) * w(0);
    const S yy = w(1) * w(1);
    const S zz = w(2) * w(2);
    const S square = xx + (yy + zz);
    const S sine = stumpff<1>(square);
    const S versine = stumpff<2>(square);
    const S x = sine * w(0);
    const S y = sine * w(1);
    const S z = sine * w(2);
    const S xy = versine * (w(0) * w(1));
    const S xz = versine * (w(0) * w(2));
    const S yz = versine * (w(1) * w(2));
    Matrix<S, 3, 3> g;
    g(0, 0) = 1.0 - versine * (yy + zz);
    g(1, 0) = xy + z;
    g(2, 0) = xz - y;
    g(0, 1) = xy - z;
    g(1, 1) = 1.0 - versine * (xx + zz);
    g(2, 1) = yz + x;
    g(0, 2) = xz + y;
    g(1, 2) = yz - x;
    g(2, 2) = 1.0 - versine * (xx + yy);
    return g;
  }

  /// The unit quaternion (w, x, y, z) with w >= 0 of a rotation matrix, from its largest component (stable at every
  /// angle; at angle pi one of the two is chosen).
  template <class S> static Vector<S, 4> quaternion(const Matrix<S, 3, 3>& g) {
    const auto d0 = value_of(g(0, 0));
    const auto d1 = value_of(g(1, 1));
    const auto d2 = value_of(g(2, 2));
    const auto by_trace = d0 + d1 + d2 >= d0 && d0 + d1 + d2 >= d1 && d0 + d1 + d2 >= d2;
    const auto by_first = d0 >= d1 && d0 >= d2;
    Vector<S, 4> q;
    if constexpr (std::same_as<std::remove_const_t<decltype(by_trace)>, bool>) {
      q = by_trace ? quaternion_by_trace(g) : quaternion_by_axis(g, by_first ? 0 : (d1 >= d2 ? 1 : 2));
    } else {
      q = quaternion_by_trace(g);
      if (!all(by_trace)) {
        const Vector<S, 4> first = quaternion_by_axis(g, 0);
        const Vector<S, 4> second = quaternion_by_axis(g, 1);
        const Vector<S, 4> third = quaternion_by_axis(g, 2);
        for (int i = 0; i < 4; ++i)
          q(i) = select(by_trace, q(i), select(by_first, first(i), select(d1 >= d2, second(i), third(i))));
      }
    }
    const auto negative = value_of(q(0)) < 0;
    for (int i = 0; i < 4; ++i) q(i) = select(negative, -q(i), q(i));
    return q;
  }
  /// The rotation matrix of a quaternion (w, x, y, z), which need not be normalised.
  static Matrix<double, 3, 3> from_quaternion(const Vector<double, 4>& q) {
    return Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized().toRotationMatrix();
  }

  /// The rotation vector, of norm at most pi; from the quaternion, hence accurate near 0 and near pi.
  template <class S> static Vector<S, 3> log(const Matrix<S, 3, 3>& g) {
    const Vector<S, 4> q = quaternion(g);
    const S ratio = angle_ratio<0>(q(0));
    return {q(1) * ratio, q(2) * ratio, q(3) * ratio};
  }

  /// cay(w) = I + (hat(w) + hat(w)^2 / 2) / (1 + |w|^2 / 4): the rotation by 2 atan(|w|/2) about w.
  template <class S> static Matrix<S, 3, 3> cayley(const Vector<S, 3>& w) {
    const S x = w(0) * w(0);
    const S y = w(1) * w(1);
    const S z = w(2) * w(2);
    const S scale = 1.0 / ((x + y + z) * 0.25 + 1.0);
    const S half = scale * 0.5;
    const Vector<S, 3> a(scale * w(0), scale * w(1), scale * w(2));
    const S xy = half * w(0) * w(1);
    const S xz = half * w(0) * w(2);
    const S yz = half * w(1) * w(2);
    Matrix<S, 3, 3> g;
    g(0, 0) = 1.0 - half * (y + z);
    g(1, 0) = xy + a(2);
    g(2, 0) = xz - a(1);
    g(0, 1) = xy - a(2);
    g(1, 1) = 1.0 - half * (x + z);
    g(2, 1) = yz + a(0);
    g(0, 2) = xz + a(1);
    g(1, 2) = yz - a(0);
    g(2, 2) = 1.0 - half * (x + y);
    return g;
  }
  /// w = 2 tan(angle/2) axis = 4 vee(g) / (1 + tr g). Requires an angle below pi.
  template <class S> static Vector<S, 3> cayley_inverse(const Matrix<S, 3, 3>& g) {
    const S scale = 2.0 / (g(0, 0) + g(1, 1) + g(2, 2) + 1.0);
    return {(g(2, 1) - g(1, 2)) * scale, (g(0, 2) - g(2, 0)) * scale, (g(1, 0) - g(0, 1)) * scale};
  }

  template <class S> static Matrix<S, 3, 3> ad(const Vector<S, 3>& w) { return hat(w); }
  template <class S> static Matrix<S, 3, 3> adjoint(const Matrix<S, 3, 3>& g) { return g; }
  template <class S> static Matrix<S, 3, 3> dexp(const Vector<S, 3>& w) {
    return dexp_from_ad<S, 3>(hat(w), w.squaredNorm());
  }
  template <class S> static Matrix<S, 3, 3> dexp_inverse(const Vector<S, 3>& w) {
    return dexp_inverse_from_ad<S, 3>(hat(w), w.squaredNorm());
  }

  /// The nearest rotation matrix to first order in the defect: one Newton-Schulz step g (3 I - g^T g) / 2.
  template <class T> static Matrix<T, 3, 3> project(const Matrix<T, 3, 3>& g) {
    const auto square = [&](int i, int j) { return g(0, i) * g(0, j) + g(1, i) * g(1, j) + g(2, i) * g(2, j); };
    const T xx = 1.5 - 0.5 * square(0, 0);
    const T yy = 1.5 - 0.5 * square(1, 1);
    const T zz = 1.5 - 0.5 * square(2, 2);
    const T xy = -0.5 * square(0, 1);
    const T xz = -0.5 * square(0, 2);
    const T yz = -0.5 * square(1, 2);
    Matrix<T, 3, 3> out;
    unrolled<3>([&]<int R>() {
      out(R, 0) = g(R, 0) * xx + g(R, 1) * xy + g(R, 2) * xz;
      out(R, 1) = g(R, 0) * xy + g(R, 1) * yy + g(R, 2) * yz;
      out(R, 2) = g(R, 0) * xz + g(R, 1) * yz + g(R, 2) * zz;
    });
    return out;
  }
  template <End Which, class T, int K>
  static Matrix<T, 3, K> frame_to_end(const Matrix<T, 3, 3>& g, const Matrix<T, 3, K>& rows) {
    Matrix<T, 3, K> out;
    for (int k = 0; k < K; ++k)
      unrolled<3>([&]<int R>() {
        out(R, k) =
            Which == End::target ? rows(R, k) : -(g(R, 0) * rows(0, k) + g(R, 1) * rows(1, k) + g(R, 2) * rows(2, k));
      });
    return out;
  }

  /// (I - g') F+ with g' = g (3 I - g^T g) / 2, the rotation nearest to g to first order: from E = g - I, whose entries
  /// are small and exact. With g itself |mu| would change by the round-off of g, the same way at every step of a smooth
  /// trajectory.
  template <class T>
  static Vector<T, 3> momentum_change(const Matrix<T, 3, 3>& g, const Vector<T, 3>&,
                                      const Vector<T, 3>& target_gradient) {
    Matrix<T, 3, 3> e = g;
    unrolled<3>([&]<int I>() { e(I, I) -= 1; });
    // S = g^T g - I
    const auto s = [&]<int I, int J>() {
      return (e(I, J) + e(J, I)) + (e(0, I) * e(0, J) + e(1, I) * e(1, J) + e(2, I) * e(2, J));
    };
    const T xy = s.template operator()<0, 1>();
    const T xz = s.template operator()<0, 2>();
    const T yz = s.template operator()<1, 2>();
    const Matrix<T, 3, 3> square{{s.template operator()<0, 0>(), xy, xz},
                                 {xy, s.template operator()<1, 1>(), yz},
                                 {xz, yz, s.template operator()<2, 2>()}};
    Vector<T, 3> out;
    unrolled<3>([&]<int R>() {
      out(R) = (0.5 * square(R, 0) - e(R, 0)) * target_gradient(0) +
               (0.5 * square(R, 1) - e(R, 1)) * target_gradient(1) +
               (0.5 * square(R, 2) - e(R, 2)) * target_gradient(2);
    });
    return out;
  }

  /// The Cayley coordinates: no trigonometric functions.
  template <class T> static Vector<T, 3> chart(const Matrix<T, 3, 3>& g) { return cayley_inverse(g); }
  template <class T> static Matrix<T, 3, 3> arrow_in_chart(const Vector<T, 0>&, const Vector<T, 3>& v) {
    return cayley(v);
  }
  /// Whole turns about an axis.
  static constexpr int loops = 1;
  static Matrix<double, 3, 3> loop(const Vector<double, 0>&, const Vector<double, 3>& axis,
                                   const Vector<double, 1>& turns) {
    return exp(Vector<double, 3>(2 * std::numbers::pi * turns(0) * axis.normalized()));
  }
  static std::string name() { return "SO(3)"; }

 private:
  template <class S> static Vector<S, 4> quaternion_by_trace(const Matrix<S, 3, 3>& g) {
    using std::sqrt;
    const S s = sqrt(g(0, 0) + g(1, 1) + g(2, 2) + 1.0) * 2.0;
    const S inverse = 1.0 / s;
    return {S(s * 0.25), (g(2, 1) - g(1, 2)) * inverse, (g(0, 2) - g(2, 0)) * inverse, (g(1, 0) - g(0, 1)) * inverse};
  }
  template <class S> static Vector<S, 4> quaternion_by_axis(const Matrix<S, 3, 3>& g, int i) {
    using std::sqrt;
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const S s = sqrt(g(i, i) - g(j, j) - g(k, k) + 1.0) * 2.0;
    Vector<S, 4> q;
    q(0) = (g(k, j) - g(j, k)) / s;
    q(1 + i) = s * 0.25;
    q(1 + j) = (g(j, i) + g(i, j)) / s;
    q(1 + k) = (g(k, i) + g(i, k)) / s;
    return q;
  }
};

using SO3 = SpecialOrthogonal3<>;

}  // namespace lagroid
