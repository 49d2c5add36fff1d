#pragma once
/// What groups of N x N matrices have in common: a group as a groupoid over a single object, with tau = exp or the
/// Cayley map cay(xi) = (I - hat(xi)/2)^{-1} (I + hat(xi)/2).
///
/// A group of one's own writes its algebra, exp and log with their differentials; the groupoid, ad, Ad and the
/// derivatives of translations follow.
///
///     template <Retraction Tau> struct MyGroup : MatrixGroup<MyGroup<Tau>, 3, 2, Tau> {  // 3 x 3, of dimension 2
///       static constexpr int basis(int i, int r, int c);  // entry (r, c) of the i-th basis matrix of the algebra
///       // hat, vee, exp, log, dexp, dexp_inverse, inverse, as in se2.hpp
///     };
///
/// Requires that basis matrices have whole entries. `cayley_inverse` requires no eigenvalue -1. Nothing throws.
///
/// Source: [G] 6.1 for the left-trivialised differentials.

#include <lagroid/core/continuous/curve_point.hpp>
#include <lagroid/core/scalars/elementary.hpp>

#include <Eigen/LU>

#include <array>
#include <concepts>
#include <string_view>

namespace lagroid {

/// The map tau : Lie algebra -> group that parametrises arrows near the unit.
enum class Retraction { exponential, cayley };
inline constexpr std::array<std::string_view, 2> retraction_words{"exp", "cayley"};

/// A group of N x N matrices as a groupoid over a single object, with Lie algebra coordinates xi in R^n, n = Dimension.
///
/// The derived class supplies hat, its entries basis(i, r, c) = hat(e_i)_rc as constants, vee, exp, log, dexp,
/// dexp_inverse and inverse; deduced here are the groupoid operations, ad, the Cayley map and its differentials, and
/// the closed-form translations.
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
    return by_entry<S>([&]<int R, int C>() {
      S sum = g(R, 0) * h(0, C);
      unrolled<N - 1>([&]<int I>() { sum += g(R, I + 1) * h(I + 1, C); });
      return sum;
    });
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
  /// tau(xi) by a map that is chosen at run time.
  template <class S> LAGROID_INLINE static Matrix<S, N, N> retract(Retraction map, const Algebra<S>& xi) {
    return map == Retraction::exponential ? Derived::exp(xi) : Derived::cayley(xi);
  }
  /// Its inverse.
  template <class S> LAGROID_INLINE static Algebra<S> retract_inverse(Retraction map, const Matrix<S, N, N>& g) {
    return map == Retraction::exponential ? Derived::log(g) : Derived::cayley_inverse(g);
  }
  /// The inverse of the matrix of its differential.
  template <class S> static Matrix<S, Dimension, Dimension> dretract_inverse(Retraction map, const Algebra<S>& xi) {
    return map == Retraction::exponential ? Derived::dexp_inverse(xi) : Derived::dcayley_inverse(xi);
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

  /// dtau_x rate: the body velocity of the curves of the chart.
  static constexpr RetractionKind retraction_kind =
      Tau == Retraction::exponential ? RetractionKind::exponential : RetractionKind::symmetric;
  template <class S>
  static Algebra<S> chart_velocity(const Vector<S, 0>&, const Algebra<S>& x, const Algebra<S>& rate) {
    Matrix<S, Dimension, Dimension> d;
    if constexpr (Tau == Retraction::exponential) {
      d = Derived::dexp(x);
    } else {
      d = Derived::dcayley(x);
    }
    Algebra<S> out;
    for (int i = 0; i < Dimension; ++i) {
      out(i) = d(i, 0) * rate(0);
      for (int j = 1; j < Dimension; ++j) out(i) += d(i, j) * rate(j);
    }
    return out;
  }

  /// The i-th basis matrix of the Lie algebra.
  static Matrix<double, N, N> generator(int i) {
    Matrix<double, N, N> e;
    for (int r = 0; r < N; ++r)
      for (int c = 0; c < N; ++c) e(r, c) = Derived::basis(i, r, c);
    return e;
  }

  /// Ad_g xi = vee(g hat(xi) g^{-1}), as a matrix.
  template <class T> static Matrix<T, Dimension, Dimension> adjoint(const Matrix<T, N, N>& g) {
    const Matrix<T, N, N> inverse = Derived::inverse(g);
    return columns<T>([&](const Matrix<T, N, N>& e) -> Matrix<T, N, N> { return g * e * inverse; });
  }

  /// The matrix of ad_x = [x, .], by commutators; the derived class may write a closed form.
  template <class S> static Matrix<S, Dimension, Dimension> ad(const Algebra<S>& x) {
    const Matrix<S, N, N> h = Derived::hat(x);
    return columns<S>([&](const Matrix<S, N, N>& e) -> Matrix<S, N, N> { return h * e - e * h; });
  }
  /// [x, y] = ad_x y, the commutator.
  template <class S> static Algebra<S> bracket(const Vector<S, 0>&, const Algebra<S>& x, const Algebra<S>& y) {
    return Derived::template ad<S>(x) * y;
  }
  template <class S> static Matrix<S, N, N> bisection(const Matrix<S, N, N>& g, const Vector<S, 0>&) { return g; }

  /// The arrow frame: g tau(u). The source displacement v is the frame's -Ad_{g^{-1}} v, because both retractions
  /// satisfy tau(v)^{-1} g = g tau(-Ad_{g^{-1}} v); and tau(u) tau(w) = tau(u + w + [u, w] / 2 + ...).
  static constexpr int arrow_dimension = Dimension;
  template <class J, int Offset = 0, class T>
  LAGROID_INLINE static Matrix<J, N, N> frame_jet(const Matrix<T, N, N>& g) {
    Matrix<J, N, N> out;
    unrolled<N>([&]<int C>() {
      unrolled<N>([&]<int R>() {
        const auto along = [](int i, const T& x) { return J::along(Offset + i, x); };
        out(R, C) = J(g(R, C), side_by_side<End::target, R, C>(g, along));
        if constexpr (J::order == 2)
          unrolled<Dimension>([&]<int I>() { out(R, C).set_row(Offset + I, squares<R, C, I>(g, along)); });
      });
    });
    return out;
  }
  template <End Which, class T, int K>
  static Matrix<T, Dimension, K> frame_to_end(const Matrix<T, N, N>& g, const Matrix<T, Dimension, K>& rows) {
    if constexpr (Which == End::target) {
      return rows.template topRows<Dimension>();  // entry by entry, see by_entry
    } else {
      return -Derived::adjoint(Derived::inverse(g)).transpose() * rows;
    }
  }
  template <class T> static Matrix<T, Dimension, Dimension> frame_bracket(const Vector<T, Dimension>& p) {
    Matrix<T, Dimension, Dimension> c;
    for (int i = 0; i < Dimension; ++i)
      c.row(i) = p.transpose() * Derived::template ad<T>(Algebra<T>(Algebra<T>::Unit(i)));
    return c;
  }

  /// Both retractions are tau(xi) = I + X + X^2/2 + O(X^3) with tau(xi)^{-1} = tau(-xi), X = hat(xi); hence the exact
  /// first and second derivatives of tau(a)^{-1} g tau(b) at a = b = 0. The loops run at compile time, so that zeros of
  /// the basis matrices cost nothing.
  template <class M, End First, End Second, int LeftOffset = 0, int RightOffset = LeftOffset, class T>
  LAGROID_INLINE static Matrix<M, N, N> seed(const Matrix<T, N, N>& g) {
    Matrix<M, N, N> out;
    unrolled<N>([&]<int C>() {
      unrolled<N>([&]<int R>() {
        const auto left =
            side_by_side<First, R, C>(g, [](int i, const T& x) { return M::left_along(LeftOffset + i, x); });
        const auto right =
            side_by_side<Second, R, C>(g, [](int j, const T& x) { return M::right_along(RightOffset + j, x); });
        out(R, C) = M(g(R, C), left, right);
        if constexpr (M::order == 2 && First == Second)
          for (int i = 0; i < Dimension; ++i)
            for (int j = 0; j < Dimension; ++j)
              out(R, C).set_mixed(LeftOffset + i, RightOffset + j, squared<First, R, C>(g, i, j));
      });
      if constexpr (M::order == 2 && First != Second) seed_mixed<Second, C, LeftOffset, RightOffset>(g, out);
    });
    return out;
  }

  /// g (I + W + W^2/2) where that is tau(w) to round-off, as in a corrector it is. Its derivatives are not those of
  /// tau to round-off, and with a scalar that carries any it is not taken.
  template <class T> LAGROID_INLINE static Matrix<T, N, N> extend(const Matrix<T, N, N>& g, const Algebra<T>& w) {
    if constexpr (Differentiated<T>) return g * tau(Object<T>{}, w);
    const auto square = value_of(w.squaredNorm());
    const auto far = square > T(1e-11);
    const auto near = square < T(1e-17);
    const Matrix<T, N, N> gw = times_hat(g, w);
    const auto linear = [&]<int R, int C>() { return g(R, C) + gw(R, C); };
    if constexpr (std::same_as<MaskOf<T>, bool>) {
      if (far) return g * tau(Object<T>{}, w);
      if (near) return by_entry<T>(linear);
    } else if (all(near)) {
      return by_entry<T>(linear);
    }
    const Matrix<T, N, N> gww = times_hat(gw, w);
    const auto quadratic = [&]<int R, int C>() { return g(R, C) + (gw(R, C) + T(0.5) * gww(R, C)); };
    if constexpr (std::same_as<MaskOf<T>, bool>) {
      return by_entry<T>(quadratic);
    } else {
      const Matrix<T, N, N> out = by_entry<T>([&]<int R, int C>() {
        return select(near, linear.template operator()<R, C>(), quadratic.template operator()<R, C>());
      });
      if (!any(far)) return out;
      const Matrix<T, N, N> turned = multiply(g, tau(Object<T>{}, w));
      return by_entry<T>([&]<int R, int C>() { return select(far, turned(R, C), out(R, C)); });
    }
  }
  template <class T> static Algebra<T> correct(Matrix<T, N, N>& g, const Algebra<T>& w) {
    const Matrix<T, N, N> gw = times_hat(g, w);
    unrolled<N * N>([&]<int K>() { g(K) += gw(K); });
    return Algebra<T>::Zero();
  }

 protected:
  /// The matrix of entries f<r, c>(). (In registers, where Eigen's packet operations would go through memory.)
  template <class S, class F> LAGROID_INLINE static Matrix<S, N, N> by_entry(const F& f) {
    Matrix<S, N, N> out;
    unrolled<N>([&]<int C>() { unrolled<N>([&]<int R>() { out(R, C) = f.template operator()<R, C>(); }); });
    return out;
  }

 private:
  /// g hat(w).
  template <class T> LAGROID_INLINE static Matrix<T, N, N> times_hat(const Matrix<T, N, N>& g, const Algebra<T>& w) {
    return by_entry<T>([&]<int R, int C>() {
      T sum = -T(0);
      unrolled<N>([&]<int S>() {
        unrolled<Dimension>([&]<int I>() {
          if constexpr (Derived::basis(I, S, C) != 0) sum += g(R, S) * (T(Derived::basis(I, S, C)) * w(I));
        });
      });
      return sum;
    });
  }

  /// Entry (r, c) of the derivative of tau(a)^{-1} g or of g tau(b) along the i-th basis vector.
  template <End Which, int R, int C, int I, class T> LAGROID_INLINE static T displaced(const Matrix<T, N, N>& g) {
    T sum = -T(0);  // the zero that adds without a trace
    unrolled<N>([&]<int S>() {
      if constexpr (Which == End::source && Derived::basis(I, R, S) != 0) sum -= T(Derived::basis(I, R, S)) * g(S, C);
      if constexpr (Which == End::target && Derived::basis(I, S, C) != 0) sum += T(Derived::basis(I, S, C)) * g(R, S);
    });
    return sum;
  }
  /// Whether that entry can be other than zero.
  template <End Which> static constexpr bool moves(int r, int c, int i) {
    for (int s = 0; s < N; ++s)
      if (Derived::basis(i, Which == End::source ? r : s, Which == End::source ? s : c) != 0) return true;
    return false;
  }

  /// These derivatives over i, each along its unit.
  template <End Which, int R, int C, class T, class Along>
  LAGROID_INLINE static auto side_by_side(const Matrix<T, N, N>& g, const Along& along) {
    decltype(along(0, g(R, C))) sum{};
    unrolled<Dimension>([&]<int I>() {
      if constexpr (moves<Which>(R, C, I)) sum = sum + along(I, displaced<Which, R, C, I>(g));
    });
    return sum;
  }

  /// The mixed derivatives -E_i g E_j where the second infinitesimal displaces the other end than the first: row i of
  /// entry (r, c) is made of the derivatives of column c along j.
  template <End Second, int C, int LeftOffset, int RightOffset, class M, class T>
  LAGROID_INLINE static void seed_mixed(const Matrix<T, N, N>& g, Matrix<M, N, N>& out) {
    using Right = typename M::Right;
    const auto along_right = [](int j, const T& x) { return M::right_along(RightOffset + j, x); };
    if constexpr (Second == End::target) {
      std::array<Right, N> along;
      unrolled<N>([&]<int S>() { along[S] = side_by_side<End::target, S, C>(g, along_right); });
      unrolled<N>([&]<int R>() {
        unrolled<Dimension>([&]<int I>() {
          Right row{};
          unrolled<N>([&]<int S>() {
            if constexpr (Derived::basis(I, R, S) != 0) row = row - T(Derived::basis(I, R, S)) * along[S];
          });
          out(R, C).set_row(LeftOffset + I, row);
        });
      });
    } else {
      unrolled<N>([&]<int R>() {
        unrolled<Dimension>([&]<int I>() {
          Right row{};
          unrolled<N>([&]<int S>() {
            if constexpr (Derived::basis(I, S, C) != 0)
              row = row + T(Derived::basis(I, S, C)) * side_by_side<End::source, R, S>(g, along_right);
          });
          out(R, C).set_row(LeftOffset + I, row);
        });
      });
    }
  }

  /// The second derivatives where both infinitesimals displace the same end: entry (r, c) of g with
  /// (E_i E_j + E_j E_i) / 2 beside it.
  template <End Which, int R, int C, class T> static T squared(const Matrix<T, N, N>& g, int i, int j) {
    T sum(0);
    for (int s = 0; s < N; ++s)
      sum += Which == End::source ? T(doubled_square(i, j, R, s)) * g(s, C) : g(R, s) * T(doubled_square(i, j, s, C));
    return sum / T(2);
  }

  /// Twice the symmetrised product (E_i E_j + E_j E_i) / 2, entry (r, c).
  static constexpr int doubled_square(int i, int j, int r, int c) {
    int sum = 0;
    for (int s = 0; s < N; ++s)
      sum += Derived::basis(i, r, s) * Derived::basis(j, s, c) + Derived::basis(j, r, s) * Derived::basis(i, s, c);
    return sum;
  }
  /// Entry (r, c) of g (E_i E_j + E_j E_i) / 2 over j, each along its unit.
  template <int R, int C, int I, class T, class Along>
  LAGROID_INLINE static auto squares(const Matrix<T, N, N>& g, const Along& along) {
    decltype(along(0, g(R, C))) sum{};
    unrolled<Dimension>([&]<int J>() {
      unrolled<N>([&]<int S>() {
        if constexpr (doubled_square(I, J, S, C) != 0)
          sum = sum + along(J, g(R, S) * (T(doubled_square(I, J, S, C)) / T(2)));
      });
    });
    return sum;
  }

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
