#pragma once
/// SO(3) on vectors and on directions: the action groupoids of heavy tops.

#include <lagroid/groupoids/action.hpp>
#include <lagroid/groupoids/groups/so3.hpp>

#include <cmath>
#include <string>

namespace lagroid {

/// R^3 with m R = R^T m: a vector fixed in space, seen from a body of attitude A_k = A_{k-1} R.
struct RotatedVectors {
  template <class S> using Point = Vector<S, 3>;
  template <class S> static Vector<S, 3> act(const Vector<S, 3>& m, const Matrix<S, 3, 3>& r) {
    const auto along = [&](int i) -> S { return r(0, i) * m(0) + (r(1, i) * m(1) + r(2, i) * m(2)); };
    return {along(0), along(1), along(2)};
  }
  static std::string name() { return "R^3"; }
};

/// S^2, the unit vectors, with the same action. Chart around m: the central projection of the tangent plane, u -> m + B
/// u normalised, with B an orthonormal basis of the plane.
struct RotatedDirections {
  template <class S> using Point = Vector<S, 3>;
  static constexpr int dimension = 2;
  template <class S> static Vector<S, 3> act(const Vector<S, 3>& m, const Matrix<S, 3, 3>& r) {
    const auto along = [&](int i) -> S { return r(0, i) * m(0) + (r(1, i) * m(1) + r(2, i) * m(2)); };
    return {along(0), along(1), along(2)};
  }
  template <class S> static Vector<S, 3> displace(const Vector<S, 3>& m, const Vector<S, 2>& u) {
    using std::sqrt;
    const Matrix<S, 3, 2> basis = tangent_basis(m);
    const S length = sqrt(u(0) * u(0) + u(1) * u(1) + 1.0);
    const auto along = [&](int i) -> S { return (m(i) + (basis(i, 0) * u(0) + basis(i, 1) * u(1))) / length; };
    return {along(0), along(1), along(2)};
  }
  template <class S> static Vector<S, 2> displacement(const Vector<S, 3>& m, const Vector<S, 3>& r) {
    const Matrix<S, 3, 2> basis = tangent_basis(m);
    const S height = m(0) * r(0) + (m(1) * r(1) + m(2) * r(2));
    const auto along = [&](int i) -> S {
      return (basis(0, i) * r(0) + (basis(1, i) * r(1) + basis(2, i) * r(2))) / height;
    };
    return {along(0), along(1)};
  }
  template <class S> static Vector<S, 3> project(const Vector<S, 3>& m) {
    using std::sqrt;
    const S length = sqrt(m(0) * m(0) + (m(1) * m(1) + m(2) * m(2)));
    return {m(0) / length, m(1) / length, m(2) / length};
  }
  /// The rotation R with m R = v that takes the orthonormal frame (B, v) of `tangent_basis` at v to that at m.
  template <class S> static Matrix<S, 3, 3> carrying(const Vector<double, 3>& m, const Vector<S, 3>& v) {
    const Matrix<S, 3, 2> at_v = tangent_basis(v);
    const Matrix<double, 3, 2> at_m = tangent_basis(m);
    Matrix<S, 3, 3> out;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) out(i, j) = at_v(j, 0) * at_m(i, 0) + at_v(j, 1) * at_m(i, 1) + v(j) * m(i);
    return out;
  }
  static std::string name() { return "S^2"; }

 private:
  /// e1 and e2 turned by the shortest rotation from +-e3 to m: smooth on both halves of the sphere (formula of Duff and
  /// others, Building an Orthonormal Basis, Revisited, J. Comput. Graph. Tech. 6 (2017)).
  template <class S> static Matrix<S, 3, 2> tangent_basis(const Vector<S, 3>& m) {
    const double sign = value_of(m(2)) < 0 ? -1 : 1;
    const S a = -1.0 / (m(2) + sign);
    const S b = m(0) * m(1) * a;
    Matrix<S, 3, 2> basis;
    basis(0, 0) = m(0) * m(0) * a * sign + 1.0;
    basis(1, 0) = b * sign;
    basis(2, 0) = m(0) * -sign;
    basis(0, 1) = b;
    basis(1, 1) = m(1) * m(1) * a + sign;
    basis(2, 1) = -m(1);
    return basis;
  }
};

}  // namespace lagroid
