#pragma once
/// SE(2), the rigid motions of the plane: [R p; 0 1] with R in SO(2), p in R^2; algebra (w, v1, v2).
///
/// Planar bodies and wheeled vehicles move on it: w turns, v is the velocity in the body's axes.
///
///     const Vector<double, 3> xi(0.1, 1, 0);  // turn, then move
///     const Matrix<double, 3, 3> g = SE2::exp(xi);
///     const Vector<double, 3> again = SE2::log(g);
///
/// `log` returns the angle in (-pi, pi]; `cayley_inverse` requires one below pi. Nothing throws.

#include <lagroid/groupoids/groups/so2.hpp>

namespace lagroid {

/// Arrows: 3 x 3 homogeneous matrices [R p; 0 1]. Algebra: xi = (w, v1, v2), hat(xi) = [hat(w) v; 0 0].
template <Retraction Tau = Retraction::exponential>
struct SpecialEuclidean2 : MatrixGroup<SpecialEuclidean2<Tau>, 3, 3, Tau> {
  template <class S> static Matrix<S, 3, 3> hat(const Vector<S, 3>& xi) {
    Matrix<S, 3, 3> x = homogeneous<S>(SO2::hat(Vector<S, 1>(xi(0))), Vector<S, 2>(xi(1), xi(2)));
    x(2, 2) = S(0);
    return x;
  }
  static constexpr int basis(int i, int r, int c) {
    if (i == 0) return r < 2 && c < 2 ? SO2::basis(0, r, c) : 0;
    return r == i - 1 && c == 2 ? 1 : 0;
  }
  template <class S> static Vector<S, 3> vee(const Matrix<S, 3, 3>& x) {
    return Vector<S, 3>(x(1, 0), x(0, 2), x(1, 2));
  }
  template <class S> static Matrix<S, 3, 3> inverse(const Matrix<S, 3, 3>& g) {
    return homogeneous<S>(SO2::inverse(rotation(g)), Vector<S, 2>(-(g(0, 0) * g(0, 2) + g(1, 0) * g(1, 2)),
                                                                  -(g(0, 1) * g(0, 2) + g(1, 1) * g(1, 2))));
  }
  template <class S> static Matrix<S, 3, 3> exp(const Vector<S, 3>& xi) {
    const Vector<S, 2> screw = screw_of(xi(0));
    return homogeneous<S>(SO2::exp(Vector<S, 1>(xi(0))),
                          Vector<S, 2>(screw(0) * xi(1) - screw(1) * xi(2), screw(1) * xi(1) + screw(0) * xi(2)));
  }
  template <class S> static Vector<S, 3> log(const Matrix<S, 3, 3>& g) {
    const S w = SO2::log(rotation(g))(0);
    // a I + b J has inverse (a I - b J) / (a^2 + b^2), and a^2 + b^2 = 2 c_2(w^2).
    const Vector<S, 2> screw = screw_of(w);
    const S scale = S(2) * stumpff<2>(S(w * w));
    return Vector<S, 3>(w, (screw(0) * g(0, 2) + screw(1) * g(1, 2)) / scale,
                        (screw(0) * g(1, 2) - screw(1) * g(0, 2)) / scale);
  }
  /// cay(w, v) = [R p; 0 1] with R the rotation by 2 atan(w/2) and p = (I + w J / 2) v / (1 + w^2 / 4), J = hat(1).
  template <class S> static Matrix<S, 3, 3> cayley(const Vector<S, 3>& xi) {
    const S half = xi(0) * 0.5;
    const S scale = 1.0 / (half * half + 1.0);
    const S c = (1.0 - half * half) * scale;
    const S s = xi(0) * scale;
    return homogeneous<S>(SO2::rotated<S>(c, s),
                          Vector<S, 2>(scale * (xi(1) - half * xi(2)), scale * (xi(2) + half * xi(1))));
  }
  /// w = 2 tan(angle/2), v = p - w J p / 2. Requires an angle below pi.
  template <class S> static Vector<S, 3> cayley_inverse(const Matrix<S, 3, 3>& g) {
    const S half = (g(1, 0) - g(0, 1)) / (g(0, 0) + g(1, 1) + 2.0);
    return Vector<S, 3>(half * 2.0, g(0, 2) + half * g(1, 2), g(1, 2) - half * g(0, 2));
  }
  template <class S> static Matrix<S, 3, 3> ad(const Vector<S, 3>& xi) {
    Matrix<S, 3, 3> a;
    for (int i = 0; i < 9; ++i) a(i) = S(0);
    a(1, 0) = xi(2);
    a(2, 0) = -xi(1);
    a(2, 1) = xi(0);
    a(1, 2) = -xi(0);
    return a;
  }
  template <class S> static Matrix<S, 3, 3> dexp(const Vector<S, 3>& xi) {
    return dexp_from_ad<S, 3>(ad(xi), S(xi(0) * xi(0)));
  }
  template <class S> static Matrix<S, 3, 3> dexp_inverse(const Vector<S, 3>& xi) {
    return dexp_inverse_from_ad<S, 3>(ad(xi), S(xi(0) * xi(0)));
  }
  static Matrix<double, 3, 3> project(const Matrix<double, 3, 3>& g) {
    return homogeneous<double>(SO2::project(rotation(g)), Vector<double, 2>(g(0, 2), g(1, 2)));
  }
  /// Of the heading, on the spot.
  static constexpr int loops = 1;
  static Matrix<double, 3, 3> loop(const Vector<double, 0>& q, const Vector<double, 3>& axis,
                                   const Vector<double, 1>& turns) {
    return homogeneous<double>(SO2::loop(q, Vector<double, 1>(axis(0)), turns), Vector<double, 2>(0, 0));
  }
  static std::string name() { return "SE(2)"; }

  /// [R p; 0 1].
  template <class S>
  static Matrix<S, 3, 3> homogeneous(const Matrix<S, 2, 2>& rotation, const Vector<S, 2>& translation) {
    Matrix<S, 3, 3> g;
    for (int i = 0; i < 2; ++i) {
      g(i, 0) = rotation(i, 0);
      g(i, 1) = rotation(i, 1);
      g(i, 2) = translation(i);
      g(2, i) = S(0);
    }
    g(2, 2) = S(1);
    return g;
  }

 private:
  template <class S> static Matrix<S, 2, 2> rotation(const Matrix<S, 3, 3>& g) {
    Matrix<S, 2, 2> out;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) out(i, j) = g(i, j);
    return out;
  }
  /// (a, b) of the matrix a I + b J, J = hat(1), that takes v to the translation part of exp(w, v): a = c_1, b = w c_2.
  template <class S> static Vector<S, 2> screw_of(const S& w) {
    const S x = w * w;
    return {stumpff<1>(x), w * stumpff<2>(x)};
  }
};

using SE2 = SpecialEuclidean2<>;

}  // namespace lagroid
