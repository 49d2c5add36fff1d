#pragma once
/// The continuous Legendre transform f*(q, y) = ext_x (y.x - f(q, x)), over any scalar and in both directions.
///
/// A system written by its Lagrangian then serves methods that need its Hamiltonian, and the other way round.
///
///     struct Particle {
///       template <class S> S lagrangian(const Vector<S, 1>& q, const Vector<S, 1>& v) const {
///         return (v.squaredNorm() - q.squaredNorm()) * 0.5;
///       }
///     };
///     const double energy = HamiltonianOf<Particle>{}.hamiltonian(q, p);
///
/// Requires a function over any scalar that is regular in its second argument. Returns values over the scalar of the
/// arguments, with derivatives.
///
/// Errors: not numbers (NaN) where Newton's method, from zero, finds no x.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/derivatives/implicit.hpp>

namespace lagroid {

/// The x with y = f_x(q, x), by Newton's method from x = 0; f(q, x) is a function over any scalar, regular in x.
template <class S, int N, class F>
Vector<S, N> legendre_inverse(const F& f, const Vector<S, N>& q, const Vector<S, N>& y) {
  const auto residual = [&]<class U>(const Vector<U, N>& x, const Vector<U, 2 * N>& qy) -> Vector<U, N> {
    const auto at = constants<Dual<U>>(part<0, N>(qy));
    Vector<U, N> out = gradient_of([&](const Vector<Dual<U>, N>& z) { return f(at, z); }, x);
    for (int i = 0; i < N; ++i) out(i) -= qy(N + i);
    return out;
  };
  return solve_implicit<S, N, 2 * N>(residual, Vector<double, N>::Zero(), joined(q, y));
}

/// f*(q, y) = ext_x (y.x - f(q, x)); f** = f.
template <class S, int N, class F> S legendre_transform(const F& f, const Vector<S, N>& q, const Vector<S, N>& y) {
  const Vector<S, N> x = legendre_inverse(f, q, y);
  return y.dot(x) - f(q, x);
}

/// H(q, p) = ext_v (p.v - L(q, v)) of a hyperregular system that writes
///
///     template <class S> S lagrangian(const Vector<S, n>& q, const Vector<S, n>& v) const
///
/// It keeps what else the system has, its `dimension` and its constraint.
template <class L> struct HamiltonianOf : L {
  template <class S, int N> S hamiltonian(const Vector<S, N>& q, const Vector<S, N>& p) const {
    return legendre_transform([this](const auto& x, const auto& v) { return this->lagrangian(x, v); }, q, p);
  }
  /// v with p = L_v(q, v).
  template <class S, int N> Vector<S, N> velocity(const Vector<S, N>& q, const Vector<S, N>& p) const {
    return legendre_inverse([this](const auto& x, const auto& v) { return this->lagrangian(x, v); }, q, p);
  }
};

/// L(q, v) = ext_p (p.v - H(q, p)) of a hyperregular system that writes
///
///     template <class S> S hamiltonian(const Vector<S, n>& q, const Vector<S, n>& p) const
template <class H> struct LagrangianOf : H {
  template <class S, int N> S lagrangian(const Vector<S, N>& q, const Vector<S, N>& v) const {
    return legendre_transform([this](const auto& x, const auto& p) { return this->hamiltonian(x, p); }, q, v);
  }
};

}  // namespace lagroid
