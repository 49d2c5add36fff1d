#pragma once
/// Potentials V(q; theta) on (S^2)^k: what a class must write to be learned.
///
///     struct Weight {
///       int size() const { return 1; }
///       template <class S, class T> S energy(const learning::Positions<S, 1>& q, const T* theta) const {
///         return S(theta[0]) * q(2);
///       }
///     };
///
/// Requires an energy in any scalars, or value and gradient in any scalar, where a formula by hand is faster.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/types.hpp>

#include <concepts>
#include <cstddef>

namespace lagroid::learning {

/// q_1, ..., q_k, column by column.
template <class S, int K> using Positions = Eigen::Matrix<S, 3, K>;

/// V(q; theta) on (S^2)^k. K is k, or Eigen::Dynamic. Supplied by the user:
///
///     int size() const                                                 how many parameters
///     template <class S, class T> S energy(const Matrix<S, 3, K>& q, const T* theta) const
///
/// in any scalars: S carries derivatives in q and in theta, T those in theta alone; S(theta[i]) makes a parameter an S.
/// Instead of an energy alone, it may write value and gradient in any scalar (GivesGradient).
template <class P>
concept Potential = requires(const P& v) {
  { v.size() } -> std::convertible_to<int>;
};

/// A potential that writes its own gradient, g <- dV/dq, and returns V; `scratch` has room for v.scratch() scalars.
template <class P, class S, int K>
concept GivesGradient = requires(const P& v, const Positions<S, K>& q, const S* theta, S* scratch, Positions<S, K>& g) {
  { v.gradient(q, theta, scratch, g) } -> std::convertible_to<S>;
  { v.scratch() } -> std::convertible_to<int>;
};

/// V and dV/dq, exactly: its own, or that of its energy, direction by direction.
template <class P, class S, int K>
S value_and_gradient(const P& v, const Positions<S, K>& q, const S* theta, [[maybe_unused]] S* scratch,
                     Positions<S, K>& g) {
  if constexpr (GivesGradient<P, S, K>) {
    return v.gradient(q, theta, scratch, g);
  } else {
    using D = Dual<S>;
    Positions<D, K> moved(3, q.cols());
    return value_and_gradient_of([&](const Positions<D, K>& at) { return v.template energy<D, S>(at, theta); }, q,
                                 moved, g);
  }
}

/// The scalars that the potential wants to work with.
template <class P> int scratch_of(const P& v) {
  if constexpr (requires { v.scratch(); }) {
    return v.scratch();
  } else {
    return 0;
  }
}

}  // namespace lagroid::learning
