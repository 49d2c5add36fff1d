#pragma once
/// SE(3), the rigid motions of space: [R p; 0 1] with R in SO(3), p in R^3; algebra (w, v), rotation first.
///
/// A free rigid body moves on it: w is its body angular velocity, v the velocity in its axes.
///
///     const SE3 groupoid{};
///     const Matrix<double, 4, 4> g = groupoid.exp(xi);
///     const Vector<double, 6> again = groupoid.log(g);
///
/// `log` returns a rotation by at most pi; `cayley_inverse` requires an angle below pi. Nothing throws.

#include <lagroid/groupoids/groups/so3.hpp>

namespace lagroid {

/// Arrows: 4 x 4 homogeneous matrices [R p; 0 1]. Algebra: xi = (w, v), rotation first, hat(xi) = [hat(w) v; 0 0].
///
/// se(3) is so(3) over the dual numbers w + e v (e^2 = 0), so its differentials are those of SO(3) evaluated on dual
/// numbers: dexp_(w, v) = [J(w) 0; J'(w; v) J(w)].
template <Retraction Tau = Retraction::exponential>
struct SpecialEuclidean3 : MatrixGroup<SpecialEuclidean3<Tau>, 4, 6, Tau> {
  template <class S> static Matrix<S, 4, 4> hat(const Vector<S, 6>& xi) {
    Matrix<S, 4, 4> x = Matrix<S, 4, 4>::Zero();
    x.template topLeftCorner<3, 3>() = SO3::hat(Vector<S, 3>(xi.template head<3>()));
    x.template topRightCorner<3, 1>() = xi.template tail<3>();
    return x;
  }
  static constexpr int basis(int i, int r, int c) {
    if (i < 3) return r < 3 && c < 3 ? SO3::basis(i, r, c) : 0;
    return r == i - 3 && c == 3 ? 1 : 0;
  }
  template <class S> static Vector<S, 6> vee(const Matrix<S, 4, 4>& x) {
    Vector<S, 6> xi;
    xi << SO3::vee(Matrix<S, 3, 3>(x.template topLeftCorner<3, 3>())), x.template topRightCorner<3, 1>();
    return xi;
  }
  template <class S> static Matrix<S, 4, 4> inverse(const Matrix<S, 4, 4>& g) {
    const Matrix<S, 3, 3> transposed = g.template topLeftCorner<3, 3>().transpose();
    return homogeneous<S>(transposed, -(transposed * g.template topRightCorner<3, 1>()));
  }
  /// R = exp(w), p = dexp_{-w} v.
  template <class S> static Matrix<S, 4, 4> exp(const Vector<S, 6>& xi) {
    const Vector<S, 3> w = xi.template head<3>();
    return homogeneous<S>(SO3::exp(w), SO3::dexp(Vector<S, 3>(-w)) * xi.template tail<3>());
  }
  template <class S> static Vector<S, 6> log(const Matrix<S, 4, 4>& g) {
    const Vector<S, 3> w = SO3::log(Matrix<S, 3, 3>(g.template topLeftCorner<3, 3>()));
    Vector<S, 6> xi;
    xi << w, SO3::dexp_inverse(Vector<S, 3>(-w)) * g.template topRightCorner<3, 1>();
    return xi;
  }
  template <class S> static Matrix<S, 6, 6> ad(const Vector<S, 6>& xi) {
    return over_dual_numbers(xi, [](const auto& w) { return SO3::ad(w); });
  }
  template <class S> static Matrix<S, 6, 6> dexp(const Vector<S, 6>& xi) {
    return over_dual_numbers(xi, [](const auto& w) { return SO3::dexp(w); });
  }
  template <class S> static Matrix<S, 6, 6> dexp_inverse(const Vector<S, 6>& xi) {
    return over_dual_numbers(xi, [](const auto& w) { return SO3::dexp_inverse(w); });
  }
  static Matrix<double, 4, 4> project(const Matrix<double, 4, 4>& g) {
    return homogeneous<double>(SO3::project(Matrix<double, 3, 3>(g.topLeftCorner<3, 3>())), g.topRightCorner<3, 1>());
  }
  /// Whole turns about an axis, on the spot.
  static constexpr int loops = 1;
  static Matrix<double, 4, 4> loop(const Vector<double, 0>& q, const Vector<double, 6>& axis,
                                   const Vector<double, 1>& turns) {
    return homogeneous<double>(SO3::loop(q, axis.head<3>(), turns), Vector<double, 3>::Zero());
  }
  static std::string name() { return "SE(3)"; }

  /// [R p; 0 1].
  template <class S>
  static Matrix<S, 4, 4> homogeneous(const Matrix<S, 3, 3>& rotation, const Vector<S, 3>& translation) {
    Matrix<S, 4, 4> g = Matrix<S, 4, 4>::Identity();
    g.template topLeftCorner<3, 3>() = rotation;
    g.template topRightCorner<3, 1>() = translation;
    return g;
  }

 private:
  template <class S, class F> static Matrix<S, 6, 6> over_dual_numbers(const Vector<S, 6>& xi, const F& f) {
    Vector<Dual<S>, 3> w;
    for (int i = 0; i < 3; ++i) w(i) = Dual<S>(xi(i), xi(3 + i));
    const Matrix<Dual<S>, 3, 3> m = f(w);
    Matrix<S, 6, 6> out = Matrix<S, 6, 6>::Zero();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        out(i, j) = out(3 + i, 3 + j) = m(i, j).value;
        out(3 + i, j) = m(i, j).derivative;
      }
    return out;
  }
};

using SE3 = SpecialEuclidean3<>;

}  // namespace lagroid
