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

#include <lagroid/core/member_name.hpp>
#include <lagroid/core/types.hpp>

#include <concepts>
#include <type_traits>
#include <utility>

namespace lagroid::learning {

/// 2n of n, of run-time size or not.
constexpr int twice(int n) { return n == Eigen::Dynamic ? Eigen::Dynamic : 2 * n; }

/// A Hamiltonian that writes its own gradient, g <- dH/dz, z = (q, p), and returns H; `scratch` has room for
/// h.scratch() scalars.
template <class H, class S, int N>
concept GivesStateGradient = requires(const H& h, const Vector<S, twice(N)>& z, const S* theta, S* scratch,
                                      Vector<S, twice(N)>& g) {
  { h.gradient(z, theta, scratch, g) } -> std::convertible_to<S>;
  { h.scratch() } -> std::convertible_to<int>;
};

namespace detail {
LAGROID_MEMBER_NAME(NamesConstraint, constraint);
LAGROID_MEMBER_NAME(NamesHamiltonian, hamiltonian);

template <class H, int N>
concept WritesHamiltonian = requires(const H& h, const Vector<double, N>& q, const Vector<double, N>& p,
                                     const double* theta) {
  { h.hamiltonian(q, p, theta) } -> std::convertible_to<double>;
};
/// Of a number of components that is known.
template <class H, int N>
concept WritesConstraint = requires(const H& h, const Vector<double, N>& q) {
  requires std::remove_cvref_t<decltype(h.constraint(q))>::RowsAtCompileTime >
  0;
};
/// What is there under these names is what will be used: another `constraint`, or a `hamiltonian` beside a gradient,
/// would be ignored.
template <class H, int N> inline constexpr bool constraint_fits = WritesConstraint<H, N> || !NamesConstraint<H>;
template <class H, int N>
inline constexpr bool energy_fits = GivesStateGradient<H, double, N> ? !NamesHamiltonian<H> : WritesHamiltonian<H, N>;
}  // namespace detail

/// H(q, p; theta). N is n, or Eigen::Dynamic. Supplied by the user:
///
///     int size() const                                                 how many parameters
///     template <class S, class T>
///     S hamiltonian(const Vector<S, N>& q, const Vector<S, N>& p, const T* theta) const
///     template <class S> Vector<S, M> constraint(const Vector<S, N>& q) const
///
/// in any scalars: S carries derivatives in q, p and theta, T those in theta alone; S(theta[i]) makes a parameter an S.
/// Without a constraint Q is R^n, else Q = {constraint(q) = 0}, its derivative of full rank, and n is not Dynamic.
/// Instead of a Hamiltonian, it may write value and gradient in z = (q, p) (GivesStateGradient). A `constraint` of
/// another kind (not const, of other arguments, or of a number of components that no type says), or both a Hamiltonian
/// and a gradient, are refused.
template <class H, int N>
concept ParametricHamiltonian = requires(const H& h) {
  { h.size() } -> std::convertible_to<int>;
}
&&detail::energy_fits<H, N>&& detail::constraint_fits<H, N>;

/// m, of Q = {constraint(q) = 0} in R^n; zero without a constraint.
template <class H, int N> constexpr int constraints_of() {
  static_assert(detail::constraint_fits<H, N>,
                "constraint(q) does not fit: a const template on the scalar, of Vector<S, N> with N a number, that "
                "returns Vector<S, M> with M a number");
  if constexpr (detail::WritesConstraint<H, N>) {
    return std::remove_cvref_t<decltype(std::declval<const H&>().constraint(
        std::declval<const Vector<double, N>&>()))>::RowsAtCompileTime;
  } else {
    return 0;
  }
}

}  // namespace lagroid::learning
