#pragma once
/// The additive group R^n.

#include <lagroid/core/groupoid.hpp>

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
  template <class M, class T> static Vector<M, N> seed(const Vector<T, N>& g, End first, End second, int offset = 0) {
    Vector<M, N> out;
    for (int i = 0; i < N; ++i) {
      out(i) = M(g(i));
      out(i).left(offset + i) = first == End::source ? -1 : 1;
      out(i).right(offset + i) = second == End::source ? -1 : 1;
    }
    return out;
  }

  /// The arrow frame: the target's displacements.
  static constexpr int arrow_dimension = N;
  template <class J, class T> static Vector<J, N> frame_jet(const Vector<T, N>& g, int offset = 0) {
    Vector<J, N> out;
    for (int i = 0; i < N; ++i) out(i) = J::variable(g(i), offset + i);
    return out;
  }
  template <class T, int K>
  static Matrix<T, N, K> frame_to_end(End end, const Vector<T, N>&, const Matrix<T, N, K>& rows) {
    return end == End::source ? Matrix<T, N, K>(-rows) : rows;
  }
  template <class T> static Matrix<T, N, N> frame_bracket(const Vector<T, N>&) { return Matrix<T, N, N>::Zero(); }

  static std::string name() { return "R^" + std::to_string(N); }
};

}  // namespace lagroid
