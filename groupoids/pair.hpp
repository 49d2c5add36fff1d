#pragma once
/// The pair groupoid R^n x R^n => R^n: arrows (q0, q1) from q0 to q1, with (q0, q1)(q1, q2) = (q0, q2).
///
/// It is the groupoid of discrete mechanics as in textbooks, L_d(q0, q1): particles, and all that has n free
/// coordinates.
///
///     const Pair<2> groupoid;
///     const auto g = groupoid.tau(Vector<double, 2>(0, 0), Vector<double, 2>(3, 4));  // {source, target}
///     const double length = (g.target - g.source).norm();
///
/// Nothing throws but `compose` in checked builds (NotComposable).

#include <lagroid/core/continuous/curve_point.hpp>

#include <string>

namespace lagroid {

/// An arrow of Pair<n>: from `source` to `target`.
template <class S, int N> struct PairArrow {
  Vector<S, N> source;
  Vector<S, N> target;
};

/// Arrows: pairs (q0, q1) of points of R^n; (q0, q1)(q1, q2) = (q0, q2). Source q0, target q1.
/// Algebroid: T R^n with the coordinate basis; anchor the identity. Retraction tau_q(v) = (q, q + v).
/// Memory: q0 then q1.
template <int N> struct Pair : LieGroupoid<Pair<N>, N> {
  template <class S> using Arrow = PairArrow<S, N>;
  template <class S> using Object = Vector<S, N>;
  static constexpr int arrow_size = 2 * N;

  template <class S> static Object<S> source(const Arrow<S>& g) { return g.source; }
  template <class S> static Object<S> target(const Arrow<S>& g) { return g.target; }
  template <class S> static Arrow<S> unit(const Vector<S, N>& q) { return {q, q}; }
  template <class S> static Arrow<S> inverse(const Arrow<S>& g) { return {g.target, g.source}; }
  template <class S> static Arrow<S> multiply(const Arrow<S>& g, const Arrow<S>& h) { return {g.source, h.target}; }
  template <class S> static Arrow<S> tau(const Vector<S, N>& q, const Vector<S, N>& v) { return {q, q + v}; }
  template <class S> static Vector<S, N> tau_inverse(const Arrow<S>& g) { return g.target - g.source; }

  template <class S> static Vector<S, N> bracket(const Vector<S, N>&, const Vector<S, N>&, const Vector<S, N>&) {
    return Vector<S, N>::Constant(S(0.0));
  }

  /// The curves of the chart are curves of R^n.
  static constexpr RetractionKind retraction_kind = RetractionKind::translation;
  template <class S>
  static Vector<S, N> chart_velocity(const Vector<S, N>&, const Vector<S, N>&, const Vector<S, N>& rate) {
    return rate;
  }

  template <class S> static Arrow<S> bisection(const Arrow<S>& g, const Vector<S, N>& q) {
    return {q, q + (g.target - g.source)};
  }

  template <class S> static Vector<S, arrow_size> coordinates(const Arrow<S>& g) {
    Vector<S, arrow_size> x;
    unrolled<N>([&]<int I>() {
      x(I) = g.source(I);
      x(N + I) = g.target(I);
    });
    return x;
  }
  template <class S, class V> static Arrow<S> arrow(const V& x) {
    Arrow<S> g;
    unrolled<N>([&]<int I>() {
      g.source(I) = S(x(I));
      g.target(I) = S(x(N + I));
    });
    return g;
  }

  template <class M, End First, End Second, int LeftOffset = 0, int RightOffset = LeftOffset, class T>
  LAGROID_INLINE static Arrow<M> seed(const PairArrow<T, N>& g) {
    const auto moved = [](End end, T x, int i) {
      return M(x, First == end ? M::left_unit(LeftOffset + i) : typename M::Left{},
               Second == end ? M::right_unit(RightOffset + i) : typename M::Right{});
    };
    Arrow<M> out;
    unrolled<N>([&]<int I>() {
      out.source(I) = moved(End::source, g.source(I), I);
      out.target(I) = moved(End::target, g.target(I), I);
    });
    return out;
  }

  template <class T> static PairArrow<T, N> extend(const PairArrow<T, N>& g, const Vector<T, N>& w) {
    return {g.source, g.target + w};
  }
  template <class T> static Vector<T, N> correct(PairArrow<T, N>& g, const Vector<T, N>& w) {
    const Vector<T, N> target = g.target + w;
    const Vector<T, N> taken = target - g.target;
    g.target = target;
    return w - taken;
  }

  /// The arrow frame: the ends move independently, first the source, then the target.
  static constexpr int arrow_dimension = 2 * N;
  template <class J, int Offset = 0, class T> LAGROID_INLINE static Arrow<J> frame_jet(const PairArrow<T, N>& g) {
    Arrow<J> out;
    unrolled<N>([&]<int I>() {
      out.source(I) = J::variable(g.source(I), Offset + I);
      out.target(I) = J::variable(g.target(I), Offset + N + I);
    });
    return out;
  }
  template <End Which, class T, int K>
  static Matrix<T, N, K> frame_to_end(const PairArrow<T, N>&, const Matrix<T, 2 * N, K>& rows) {
    Matrix<T, N, K> out;
    for (int k = 0; k < K; ++k) unrolled<N>([&]<int I>() { out(I, k) = rows((Which == End::source ? 0 : N) + I, k); });
    return out;
  }
  template <class T> static Matrix<T, 2 * N, 2 * N> frame_bracket(const Vector<T, 2 * N>&) {
    return Matrix<T, 2 * N, 2 * N>::Zero();
  }

  static std::string name() { return "Pair<" + std::to_string(N) + ">"; }
};

}  // namespace lagroid
