#pragma once
/// Hamiltonians H(q, p; theta) on R^2n, or on T*Q of a Q in R^n: what a class must write to be learned. It need not be
/// a kinetic energy and a potential.
///
///     struct Bead {  // on a parabola, in a plane: a mass and a weight
///       int size() const { return 2; }
///       template <class S, class T>
///       S hamiltonian(const Vector<S, 2>& q, const Vector<S, 2>& p, const T* theta) const {
///         return p.squaredNorm() * S(theta[0]) + q(1) * S(theta[1]);
///       }
///       template <class S> Vector<S, 1> constraint(const Vector<S, 2>& q) const {
///         return Vector<S, 1>(q(1) - q(0) * q(0));
///       }
///     };
///
/// Requires a Hamiltonian in any scalars, or value and gradient in any scalar, where a formula by hand is faster
/// (Polynomial, Network).

#include <lagroid/core/scalars/dual.hpp>
#include <lagroid/core/types.hpp>

#include <concepts>
#include <utility>

namespace lagroid::learning {

/// 2n of n, of run-time size or not.
constexpr int twice(int n) { return n == Eigen::Dynamic ? Eigen::Dynamic : 2 * n; }

/// H(q, p; theta). N is n, or Eigen::Dynamic. Supplied by the user:
///
///     int size() const                                                 how many parameters
///     template <class S, class T>
///     S hamiltonian(const Vector<S, N>& q, const Vector<S, N>& p, const T* theta) const
///     template <class S> Vector<S, M> constraint(const Vector<S, N>& q) const
///
/// in any scalars: S carries derivatives in q, p and theta, T those in theta alone; S(theta[i]) makes a parameter an S.
/// Without a constraint Q is R^n, else Q = {constraint(q) = 0}, its derivative of full rank, and n is not Dynamic.
/// Instead of a Hamiltonian, it may write value and gradient in z = (q, p) (GivesStateGradient).
template <class H>
concept ParametricHamiltonian = requires(const H& h) {
  { h.size() } -> std::convertible_to<int>;
};

/// A Hamiltonian that writes its own gradient, g <- dH/dz, z = (q, p), and returns H; `scratch` has room for
/// h.scratch() scalars.
template <class H, class S, int N>
concept GivesStateGradient = requires(const H& h, const Vector<S, twice(N)>& z, const S* theta, S* scratch,
                                      Vector<S, twice(N)>& g) {
  { h.gradient(z, theta, scratch, g) } -> std::convertible_to<S>;
  { h.scratch() } -> std::convertible_to<int>;
};

/// m, of Q = {constraint(q) = 0} in R^n.
template <class H, int N> constexpr int constraints_of() {
  if constexpr (requires(const H& h, const Vector<double, N>& q) { h.constraint(q); }) {
    return decltype(std::declval<const H&>().constraint(std::declval<const Vector<double, N>&>()))::RowsAtCompileTime;
  } else {
    return 0;
  }
}

}  // namespace lagroid::learning
