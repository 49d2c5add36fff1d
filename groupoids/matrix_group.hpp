#pragma once
/// What the matrix groups SO(2), SO(3), SE(2), SE(3) have in common.

#include <lagroid/core/groupoid.hpp>

#include <Eigen/LU>

#include <array>

namespace lagroid {

/// The map tau : Lie algebra -> group that parametrises arrows near the unit.
enum class Retraction { exponential, cayley };

/// A group of N x N matrices as a groupoid over a single object, with Lie algebra coordinates xi in R^n, n = Dimension.
///
/// The derived class supplies hat, vee, exp, log, ad, dexp, dexp_inverse and inverse; deduced here are the groupoid
/// operations, the Cayley map and its differentials, and the closed-form translations.
///
/// Differentials are left-trivialised ([G] 6.1): d/dt tau(xi + t eta) = tau(xi) hat(dtau_xi eta).
template <class Derived, int N, int Dimension, Retraction Tau>
class MatrixGroup : public LieGroupoid<Derived, Dimension> {
 public:
  template <class S> using Arrow = Matrix<S, N, N>;
  template <class S> using Object = Vector<S, 0>;
  template <class S> using Algebra = Vector<S, Dimension>;
  static constexpr int matrix_size = N;
  static constexpr Retraction retraction = Tau;

  template <class S> static Object<S> source(const Matrix<S, N, N>&) { return {}; }
  template <class S> static Object<S> target(const Matrix<S, N, N>&) { return {}; }
  template <class S> static Matrix<S, N, N> unit(const Vector<S, 0>&) { return Matrix<S, N, N>::Identity(); }
  template <class S> static Matrix<S, N, N> multiply(const Matrix<S, N, N>& g, const Matrix<S, N, N>& h) {
    return g * h;
  }
  template <class S> static Matrix<S, N, N> tau(const Vector<S, 0>&, const Algebra<S>& xi) {
    if constexpr (Tau == Retraction::exponential) {
      return Derived::exp(xi);
    } else {
      return Derived::cayley(xi);
    }
  }
  template <class S> static Algebra<S> tau_inverse(const Matrix<S, N, N>& g) {
    if constexpr (Tau == Retraction::exponential) {
      return Derived::log(g);
    } else {
      return Derived::cayley_inverse(g);
    }
  }

  /// cay(xi) = (I - hat(xi)/2)^{-1} (I + hat(xi)/2).
  template <class S> static Matrix<S, N, N> cayley(const Algebra<S>& xi) {
    const Matrix<S, N, N> half = Derived::hat(xi) * S(0.5);
    const Matrix<S, N, N> one = Matrix<S, N, N>::Identity();
    return (one - half).eval().inverse() * (one + half);
  }
  /// xi with cay(xi) = g: hat(xi) = 2 (g - I)(g + I)^{-1}. Requires that g has no eigenvalue -1 (rotation angle below
  /// pi).
  template <class S> static Algebra<S> cayley_inverse(const Matrix<S, N, N>& g) {
    const Matrix<S, N, N> one = Matrix<S, N, N>::Identity();
    return Derived::vee(((g - one) * (g + one).eval().inverse() * S(2)).eval());
  }
  /// The matrix of dcay_xi: hat(dcay_xi eta) = (I + hat(xi)/2)^{-1} hat(eta) (I - hat(xi)/2)^{-1}.
  template <class S> static Matrix<S, Dimension, Dimension> dcayley(const Algebra<S>& xi) {
    const Matrix<S, N, N> half = Derived::hat(xi) * S(0.5);
    const Matrix<S, N, N> one = Matrix<S, N, N>::Identity();
    const Matrix<S, N, N> plus = (one + half).eval().inverse();
    const Matrix<S, N, N> minus = (one - half).eval().inverse();
    return columns<S>([&](const Matrix<S, N, N>& e) -> Matrix<S, N, N> { return plus * e * minus; });
  }
  /// The inverse of the matrix dcayley(xi).
  template <class S> static Matrix<S, Dimension, Dimension> dcayley_inverse(const Algebra<S>& xi) {
    const Matrix<S, N, N> half = Derived::hat(xi) * S(0.5);
    const Matrix<S, N, N> one = Matrix<S, N, N>::Identity();
    return columns<S>([&](const Matrix<S, N, N>& e) -> Matrix<S, N, N> { return (one + half) * e * (one - half); });
  }

  /// The i-th basis matrix of the Lie algebra.
  static Matrix<double, N, N> generator(int i) { return Derived::hat(Algebra<double>(Algebra<double>::Unit(i))); }

  /// Ad_g xi = vee(g hat(xi) g^{-1}), as a matrix.
  template <class T> static Matrix<T, Dimension, Dimension> adjoint(const Matrix<T, N, N>& g) {
    const Matrix<T, N, N> inverse = Derived::inverse(g);
    return columns<T>([&](const Matrix<T, N, N>& e) -> Matrix<T, N, N> { return g * e * inverse; });
  }

  /// The arrow frame: g tau(u). The source displacement v is the frame's -Ad_{g^{-1}} v, because both retractions
  /// satisfy tau(v)^{-1} g = g tau(-Ad_{g^{-1}} v); and tau(u) tau(w) = tau(u + w + [u, w] / 2 + ...).
  static constexpr int arrow_dimension = Dimension;
  template <class J, class T> static Matrix<J, N, N> frame_jet(const Matrix<T, N, N>& g, int offset = 0) {
    struct Generators {
      std::array<Matrix<T, N, N>, Dimension> first;
      std::array<Matrix<T, N, N>, Dimension*(Dimension + 1) / 2> second;  // symmetrised products, row by row
    };
    static const auto basis = [] {
      Generators e;
      for (int i = 0, at = 0; i < Dimension; ++i) {
        e.first[i] = generator(i).template cast<T>();
        for (int j = 0; j <= i; ++j) e.second[at++] = (e.first[i] * e.first[j] + e.first[j] * e.first[i]).eval() / T(2);
      }
      return e;
    }();
    Matrix<J, N, N> out;
    for (int k = 0; k < g.size(); ++k) out(k) = J(g(k));
    for (int i = 0, at = 0; i < Dimension; ++i) {
      const Matrix<T, N, N> first = g * basis.first[i];
      for (int k = 0; k < g.size(); ++k) out(k).gradient(offset + i) = first(k);
      for (int j = 0; j <= i; ++j) {
        const Matrix<T, N, N> second = g * basis.second[at++];
        for (int k = 0; k < g.size(); ++k) out(k).hessian(offset + i, offset + j) = second(k);
      }
    }
    return out;
  }
  template <class T, int K>
  static Matrix<T, Dimension, K> frame_to_end(End end, const Matrix<T, N, N>& g, const Matrix<T, Dimension, K>& rows) {
    if (end == End::target) return rows;
    return -Derived::adjoint(Derived::inverse(g)).transpose() * rows;
  }
  template <class T> static Matrix<T, Dimension, Dimension> frame_bracket(const Vector<T, Dimension>& p) {
    Matrix<T, Dimension, Dimension> c;
    for (int i = 0; i < Dimension; ++i)
      c.row(i) = p.transpose() * Derived::template ad<T>(Algebra<T>(Algebra<T>::Unit(i)));
    return c;
  }

  /// Both retractions are tau(xi) = I + X + X^2/2 + O(X^3) with tau(xi)^{-1} = tau(-xi), X = hat(xi); hence the exact
  /// first and second derivatives of tau(a)^{-1} g tau(b) at a = b = 0.
  template <class M, class T>
  static Matrix<M, N, N> seed(const Matrix<T, N, N>& g, End first, End second, int offset = 0) {
    static const auto basis = [] {
      std::array<Matrix<T, N, N>, Dimension> e;
      for (int i = 0; i < Dimension; ++i) e[i] = generator(i).template cast<T>();
      return e;
    }();
    Matrix<M, N, N> out;
    for (int k = 0; k < g.size(); ++k) out(k) = M(g(k));
    for (int i = 0; i < Dimension; ++i) {
      const Matrix<T, N, N> from_source = -basis[i] * g;
      const Matrix<T, N, N> from_target = g * basis[i];
      const Matrix<T, N, N>& by_first = first == End::source ? from_source : from_target;
      const Matrix<T, N, N>& by_second = second == End::source ? from_source : from_target;
      for (int k = 0; k < g.size(); ++k) {
        out(k).left(offset + i) = by_first(k);
        out(k).right(offset + i) = by_second(k);
      }
      for (int j = 0; j < Dimension; ++j) {
        const Matrix<T, N, N> square = (basis[i] * basis[j] + basis[j] * basis[i]) / T(2);
        Matrix<T, N, N> c;
        if (first == End::source && second == End::target) c = from_source * basis[j];
        if (first == End::target && second == End::source) c = -basis[j] * from_target;
        if (first == End::source && second == End::source) c = square * g;
        if (first == End::target && second == End::target) c = g * square;
        for (int k = 0; k < g.size(); ++k) out(k).mixed(offset + i, offset + j) = c(k);
      }
    }
    return out;
  }

 private:
  template <class S, class F> static Matrix<S, Dimension, Dimension> columns(const F& conjugate) {
    Matrix<S, Dimension, Dimension> d;
    for (int i = 0; i < Dimension; ++i) d.col(i) = Derived::vee(conjugate(generator(i).template cast<S>().eval()));
    return d;
  }
};

/// dexp_xi = sum_k (-ad_xi)^k / (k+1)! where ad^3 = -x ad, x the squared rotation angle (so(3), se(2)).
template <class S, int N> Matrix<S, N, N> dexp_from_ad(const Matrix<S, N, N>& ad, const S& x) {
  return Matrix<S, N, N>::Identity() - stumpff<2>(x) * ad + stumpff<3>(x) * (ad * ad).eval();
}

/// The inverse of dexp_from_ad: I + ad/2 + d ad^2 with d = (1 - (a/2) cot(a/2))/a^2, x = a^2, written without
/// cancellation. Requires a rotation angle below 2 pi.
template <class S, int N> Matrix<S, N, N> dexp_inverse_from_ad(const Matrix<S, N, N>& ad, const S& x) {
  const S d = (stumpff<3>(x) - S(2) * stumpff<4>(x)) / (S(2) * stumpff<2>(x));
  return Matrix<S, N, N>::Identity() + S(0.5) * ad + d * (ad * ad).eval();
}

}  // namespace lagroid
