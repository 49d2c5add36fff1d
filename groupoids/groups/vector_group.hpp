#pragma once
/// The additive group R^n as a groupoid over a single object: arrows are vectors, and their product is the sum.
///
/// Quantities of which the changes alone matter: an area, a cost, an angle that is counted.
///
///     const VectorGroup<2> groupoid;
///     const Vector<double, 2> sum = groupoid.multiply(Vector<double, 2>(1, 2), Vector<double, 2>(3, 4));  // (4, 6)
///
/// Nothing throws.

#include <lagroid/core/continuous/curve_point.hpp>

#include <string>

namespace lagroid {

/// Arrows: vectors of R^n under addition, over a single object. Algebroid: R^n, zero anchor, zero bracket. Retraction:
/// the identity (it is the exponential map). Memory: the vector.
template <int N> struct VectorGroup : LieGroupoid<VectorGroup<N>, N> {
  template <class S> using Arrow = Vector<S, N>;
  template <class S> using Object = Vector<S, 0>;

  template <class S> static Object<S> source(const Vector<S, N>&) { return {}; }
  template <class S> static Object<S> target(const Vector<S, N>&) { return {}; }
  template <class S> static Vector<S, N> unit(const Vector<S, 0>&) { return Vector<S, N>::Constant(S(0)); }
  template <class S> static Vector<S, N> inverse(const Vector<S, N>& g) { return -g; }
  template <class S> static Vector<S, N> multiply(const Vector<S, N>& g, const Vector<S, N>& h) { return g + h; }
  template <class S> static Vector<S, N> tau(const Vector<S, 0>&, const Vector<S, N>& v) { return v; }
  template <class S> static Vector<S, N> tau_inverse(const Vector<S, N>& g) { return g; }
  template <class S> static Vector<S, N> bracket(const Vector<S, 0>&, const Vector<S, N>&, const Vector<S, N>&) {
    return Vector<S, N>::Constant(S(0.0));
  }
  static constexpr RetractionKind retraction_kind = RetractionKind::translation;
  template <class S>
  static Vector<S, N> chart_velocity(const Vector<S, 0>&, const Vector<S, N>&, const Vector<S, N>& rate) {
    return rate;
  }
  template <class S> static Vector<S, N> bisection(const Vector<S, N>& g, const Vector<S, 0>&) { return g; }
  template <class M, End First, End Second, int LeftOffset = 0, int RightOffset = LeftOffset, class T>
  LAGROID_INLINE static Vector<M, N> seed(const Vector<T, N>& g) {
    constexpr T by_first = First == End::source ? -1 : 1;
    constexpr T by_second = Second == End::source ? -1 : 1;
    Vector<M, N> out;
    unrolled<N>([&]<int I>() {
      out(I) = M(g(I), by_first * M::left_unit(LeftOffset + I), by_second * M::right_unit(RightOffset + I));
    });
    return out;
  }

  /// The arrow frame: the target's displacements.
  static constexpr int arrow_dimension = N;
  template <class J, int Offset = 0, class T> LAGROID_INLINE static Vector<J, N> frame_jet(const Vector<T, N>& g) {
    Vector<J, N> out;
    unrolled<N>([&]<int I>() { out(I) = J::variable(g(I), Offset + I); });
    return out;
  }
  template <End Which, class T, int K>
  static Matrix<T, N, K> frame_to_end(const Vector<T, N>&, const Matrix<T, N, K>& rows) {
    return (Which == End::source ? T(-1) : T(1)) * rows;
  }
  template <class T> static Matrix<T, N, N> frame_bracket(const Vector<T, N>&) { return Matrix<T, N, N>::Zero(); }

  static std::string name() { return "R^" + std::to_string(N); }
};

}  // namespace lagroid
