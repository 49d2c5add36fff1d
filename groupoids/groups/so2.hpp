#pragma once
/// SO(2), the rotations of the plane: exp(w) turns by the angle w.
///
/// An angle in a matrix has no seam: motions go round and round without a jump from pi to -pi.
///
///     const Matrix<double, 2, 2> g = SO2::exp(Vector<double, 1>(0.1));
///     const double angle = SO2::log(g)(0);  // in (-pi, pi]
///
/// Nothing throws.

#include <lagroid/groupoids/groups/matrix_group.hpp>

#include <cmath>
#include <numbers>

namespace lagroid {

/// Arrows: 2 x 2 rotation matrices. Algebra: the angle rate xi = (w), hat(w) = [[0, -w], [w, 0]]; Abelian.
template <Retraction Tau = Retraction::exponential>
struct SpecialOrthogonal2 : MatrixGroup<SpecialOrthogonal2<Tau>, 2, 1, Tau> {
  template <class S> static Matrix<S, 2, 2> hat(const Vector<S, 1>& xi) { return rotated<S>(S(0), xi(0)); }
  static constexpr int basis(int, int r, int c) { return r - c; }
  template <class S> static Vector<S, 1> vee(const Matrix<S, 2, 2>& x) { return Vector<S, 1>(x(1, 0)); }
  template <class S> static Matrix<S, 2, 2> inverse(const Matrix<S, 2, 2>& g) {
    Matrix<S, 2, 2> out;
    out(0, 0) = g(0, 0);
    out(1, 0) = g(0, 1);
    out(0, 1) = g(1, 0);
    out(1, 1) = g(1, 1);
    return out;
  }
  template <class S> static Matrix<S, 2, 2> exp(const Vector<S, 1>& xi) {
    using std::cos, std::sin;
    return rotated<S>(cos(xi(0)), sin(xi(0)));
  }
  /// The angle in (-pi, pi].
  template <class S> static Vector<S, 1> log(const Matrix<S, 2, 2>& g) {
    using std::atan2;
    return Vector<S, 1>(atan2(g(1, 0), g(0, 0)));
  }
  template <class S> static Matrix<S, 1, 1> ad(const Vector<S, 1>&) { return Matrix<S, 1, 1>(S(0)); }
  template <class S> static Matrix<S, 1, 1> dexp(const Vector<S, 1>&) { return Matrix<S, 1, 1>(S(1)); }
  template <class S> static Matrix<S, 1, 1> dexp_inverse(const Vector<S, 1>&) { return Matrix<S, 1, 1>(S(1)); }
  /// The first column renormalised, the second its quarter turn.
  static Matrix<double, 2, 2> project(const Matrix<double, 2, 2>& g) {
    const Vector<double, 2> e = g.col(0).normalized();
    return rotated<double>(e(0), e(1));
  }
  /// Of the angle.
  static constexpr int loops = 1;
  static Matrix<double, 2, 2> loop(const Vector<double, 0>&, const Vector<double, 1>&, const Vector<double, 1>& turns) {
    return exp(Vector<double, 1>(2 * std::numbers::pi * turns));
  }
  static std::string name() { return "SO(2)"; }

  /// x I + y J, J = hat(1): the matrix of the complex number x + i y.
  template <class S> static Matrix<S, 2, 2> rotated(const S& x, const S& y) {
    Matrix<S, 2, 2> out;
    out(0, 0) = x;
    out(1, 0) = y;
    out(0, 1) = -y;
    out(1, 1) = x;
    return out;
  }
};

using SO2 = SpecialOrthogonal2<>;

}  // namespace lagroid
