#pragma once
/// Products of spheres (S^2)^k and of their cotangent bundles (T*S^2)^k, with the groups SO(3)^k and SE(3)^k that act
/// on them: homogeneous spaces.
///
/// Chains of pendulums and other systems of directions live here; integrators that move by the group keep |q| = 1 and
/// q.p = 0 without coordinates.
///
///     const CotangentSpheres<1> space{};
///     CotangentSpheres<1>::Point z = space.zero_point();
///     z << 0, 0, 1, 0.5, 0, 0;          // q, then p
///     space.act(CotangentSpheres<1>::Algebra(u), z);  // exp(u) z, u = (xi, eta) in se(3)
///
/// Requires points on the space, up to round-off; `project` returns them there, to first order. K may be
/// Eigen::Dynamic, with `count` factors. Nothing throws.
///
/// Source: [H] (act), (infgen).

#include <lagroid/core/scalars/elementary.hpp>
#include <lagroid/core/scalars/special_functions.hpp>
#include <lagroid/core/types.hpp>

#include <cmath>
#include <string>

namespace lagroid {

/// a x b, in any scalars.
template <class A, class B> LAGROID_INLINE inline auto cross(const A& a, const B& b) {
  using S = typename A::Scalar;
  return Vector<S, 3>(a(1) * b(2) - a(2) * b(1), a(2) * b(0) - a(0) * b(2), a(0) * b(1) - a(1) * b(0));
}

/// (S^2)^k with SO(3)^k acting factor by factor, exp(w) q = q + c_1 w x q + c_2 w x (w x q). K is k, or Eigen::Dynamic.
/// Points and algebra: 3 x k, column i belongs to the i-th factor.
template <int K, class S = double> struct Spheres {
  using Point = Eigen::Matrix<S, 3, K>;
  using Algebra = Eigen::Matrix<S, 3, K>;
  int count = K == Eigen::Dynamic ? 1 : K;  ///< k

  Point zero_point() const { return Point::Zero(3, count); }
  Algebra zero_algebra() const { return Algebra::Zero(3, count); }

  void act(const Algebra& u, Point& z) const {
    for (int i = 0; i < z.cols(); ++i) {
      const Vector<S, 3> w = u.col(i);
      const Vector<S, 3> q = z.col(i);
      const S x = w.squaredNorm();
      const Vector<S, 3> wq = cross(w, q);
      z.col(i) = q + stumpff<1>(x) * wq + stumpff<2>(x) * cross(w, wq);
    }
  }
  void generator(const Algebra& u, const Point& z, Point& v) const {
    for (int i = 0; i < z.cols(); ++i) v.col(i) = cross(Vector<S, 3>(u.col(i)), Vector<S, 3>(z.col(i)));
  }
  void bracket(const Algebra& u, const Algebra& v, Algebra& w) const {
    for (int i = 0; i < u.cols(); ++i) w.col(i) = cross(Vector<S, 3>(u.col(i)), Vector<S, 3>(v.col(i)));
  }
  /// One Newton step towards |q| = 1.
  void project(Point& z) const {
    for (int i = 0; i < z.cols(); ++i) z.col(i) *= 1.5 - 0.5 * S(z.col(i).squaredNorm());
  }
  std::string name() const { return "(S^2)^" + std::to_string(count); }
};

namespace detail {

/// 6 x k, two vectors in a column.
template <int K, class S> struct PairsOfVectors {
  using Point = Eigen::Matrix<S, 6, K>;
  using Algebra = Eigen::Matrix<S, 6, K>;
  using V = Vector<S, 3>;
  int count = K == Eigen::Dynamic ? 1 : K;  ///< k

  Point zero_point() const { return Point::Zero(6, count); }
  Algebra zero_algebra() const { return Algebra::Zero(6, count); }

  /// The first of column i, as q_i or xi_i.
  template <class Z> LAGROID_INLINE static V first(const Z& z, int i) { return z.col(i).template head<3>(); }
  /// The second, as p_i or eta_i.
  template <class Z> LAGROID_INLINE static V second(const Z& z, int i) { return z.col(i).template tail<3>(); }
  template <class Z> LAGROID_INLINE static void set(Z& z, int i, const V& a, const V& b) {
    z.col(i).template head<3>() = a;
    z.col(i).template tail<3>() = b;
  }
};

}  // namespace detail

/// (T*S^2)^k, and (TS^2)^k, which the metric of S^2 makes the same: pairs (q, p) with |q| = 1, q.p = 0. SE(3)^k acts by
/// (R, r)(q, p) = (R q, R p + r x R q) ([H] (act)); for u = (xi, eta) in se(3), R = exp(xi) and r = eta + c_2 xi x eta
/// + c_3 xi x (xi x eta), and u_M(q, p) = (xi x q, xi x p + eta x q) ([H] (infgen)). K is k, or Eigen::Dynamic. Points
/// and algebra: 6 x k, column i holds (q_i, p_i), or (xi_i, eta_i).
template <int K, class S = double> struct CotangentSpheres : detail::PairsOfVectors<K, S> {
  using Pairs = detail::PairsOfVectors<K, S>;
  using Pairs::first, Pairs::second, Pairs::set;
  using typename Pairs::Algebra, typename Pairs::Point, typename Pairs::V;

  void act(const Algebra& u, Point& z) const {
    for (int i = 0; i < z.cols(); ++i) {
      const V xi = first(u, i);
      const V eta = second(u, i);
      const V q = first(z, i);
      const V p = second(z, i);
      const S x = xi.squaredNorm();
      const S c1 = stumpff<1>(x);
      const S c2 = stumpff<2>(x);
      const V xq = cross(xi, q);
      const V xp = cross(xi, p);
      const V xe = cross(xi, eta);
      const V turned = q + c1 * xq + c2 * cross(xi, xq);
      const V r = eta + c2 * xe + stumpff<3>(x) * cross(xi, xe);
      set(z, i, turned, p + c1 * xp + c2 * cross(xi, xp) + cross(r, turned));
    }
  }
  void generator(const Algebra& u, const Point& z, Point& v) const {
    for (int i = 0; i < z.cols(); ++i) {
      const V xi = first(u, i);
      const V q = first(z, i);
      set(v, i, cross(xi, q), cross(xi, second(z, i)) + cross(second(u, i), q));
    }
  }
  void bracket(const Algebra& u, const Algebra& v, Algebra& w) const {
    for (int i = 0; i < u.cols(); ++i) {
      const V a = first(u, i);
      const V b = first(v, i);
      set(w, i, cross(a, b), cross(a, second(v, i)) + cross(second(u, i), b));
    }
  }
  /// One Newton step towards |q| = 1, then p without its part along q.
  void project(Point& z) const {
    for (int i = 0; i < z.cols(); ++i) {
      const V p = second(z, i);
      V q = first(z, i);
      q *= 1.5 - 0.5 * S(q.squaredNorm());
      set(z, i, q, p - q * S(q.dot(p)));
    }
  }
  std::string name() const { return "(T*S^2)^" + std::to_string(this->count); }
};

/// (S^2 x R^3)^k with (SO(3) x R^3)^k acting, (R, a)(q, w) = (R q, w + a), of the algebra's (xi, eta) the exponential
/// (exp(xi), eta): directions with vectors that do not turn with them, as angular velocities. K is k, or
/// Eigen::Dynamic. Points and algebra: 6 x k, column i holds (q_i, w_i), or (xi_i, eta_i).
template <int K, class S = double> struct SpheresAndVectors : detail::PairsOfVectors<K, S> {
  using Pairs = detail::PairsOfVectors<K, S>;
  using Pairs::first, Pairs::second, Pairs::set;
  using typename Pairs::Algebra, typename Pairs::Point, typename Pairs::V;

  void act(const Algebra& u, Point& z) const {
    for (int i = 0; i < z.cols(); ++i) {
      const V xi = first(u, i);
      const V q = first(z, i);
      const S x = xi.squaredNorm();
      const V xq = cross(xi, q);
      set(z, i, q + stumpff<1>(x) * xq + stumpff<2>(x) * cross(xi, xq), second(z, i) + second(u, i));
    }
  }
  /// z <- cay(2 h u) z, by angles 2 arctan(h |xi|): no sine and no cosine. With -h it goes back.
  void leap(const S& h, const Algebra& u, Point& z) const {
    for (int i = 0; i < z.cols(); ++i) {
      const V xi = first(u, i) * h;
      const V q = first(z, i);
      const V xq = cross(xi, q);
      const S c = S(2.0) / (xi.squaredNorm() + 1.0);
      set(z, i, q + (xq + cross(xi, xq)) * c, second(z, i) + second(u, i) * (h * 2.0));
    }
  }
  /// The same, or where `halved` is 1 and not 0 what has to be done twice for that: by arctan(h |xi|).
  void leap(const S& h, const S& halved, const Algebra& u, Point& z) const {
    using std::sqrt;
    for (int i = 0; i < z.cols(); ++i) {
      const V xi = first(u, i) * h;
      const V q = first(z, i);
      const V xq = cross(xi, q);
      const S square = S(1.0) / (xi.squaredNorm() + 1.0);
      const S cosine = sqrt(square);  // of arctan(h |xi|)
      const S whole = square * 2.0;
      const S c1 = whole + halved * (cosine - whole);
      const S c2 = whole + halved * (square / (cosine + 1.0) - whole);
      set(z, i, q + xq * c1 + cross(xi, xq) * c2, second(z, i) + second(u, i) * (h * (S(2.0) - halved)));
    }
  }
  void generator(const Algebra& u, const Point& z, Point& v) const {
    for (int i = 0; i < z.cols(); ++i) set(v, i, cross(first(u, i), first(z, i)), second(u, i));
  }
  void bracket(const Algebra& u, const Algebra& v, Algebra& w) const {
    for (int i = 0; i < u.cols(); ++i) set(w, i, cross(first(u, i), first(v, i)), V::Zero());
  }
  /// One Newton step towards |q| = 1.
  void project(Point& z) const {
    for (int i = 0; i < z.cols(); ++i) {
      const V q = first(z, i);
      set(z, i, q * (1.5 - 0.5 * S(q.squaredNorm())), second(z, i));
    }
  }
  std::string name() const { return "(S^2 x R^3)^" + std::to_string(this->count); }
};

}  // namespace lagroid
