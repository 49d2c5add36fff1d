#pragma once
/// Vectors and matrices of fixed size over a scalar S, and the functions that a formula needs to serve every S.
///
/// A formula written once for any S gives numbers (double), their derivatives (Jet, HyperDual, Dual, Series) and the
/// numbers of several members of an ensemble at once (Batch).
///
///     template <class S> S positive_part(const Vector<S, 2>& q) {
///       return select(value_of(q(0)) > 0, q(0), S(0));
///     }
///
/// `select` takes the place of a branch: it evaluates both values and returns one of them, for a Batch lane by lane.
/// Nothing here throws.

#include <Eigen/Core>

#include <type_traits>
#include <utility>

// Operations on derivatives must be inlined to stay in registers, and all that a step calls with them. Instrumented or
// unoptimised code has nothing to gain, and would take minutes to compile; nor has one that is run for a moment
// (LAGROID_COMPACT).
#if defined(__SANITIZE_ADDRESS__)
#define LAGROID_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LAGROID_SANITIZED
#endif
#endif
#if defined(__OPTIMIZE__) && !defined(LAGROID_SANITIZED) && !defined(LAGROID_COMPACT)
#define LAGROID_INLINE [[gnu::always_inline]]
#define LAGROID_FLATTEN [[gnu::flatten]]
#else
#define LAGROID_INLINE
#define LAGROID_FLATTEN
#endif

namespace lagroid {

/// f(), called: inlining by force (LAGROID_FLATTEN) ends here.
template <class F> [[gnu::noinline]] auto apart(const F& f) { return f(); }

template <class S, int N> using Vector = Eigen::Matrix<S, N, 1>;

template <class S, int Rows, int Columns> using Matrix = Eigen::Matrix<S, Rows, Columns>;

/// The underlying real number of a scalar: itself for a real, the value part for a derivative-carrying scalar.
constexpr double value_of(double x) { return x; }
constexpr float value_of(float x) { return x; }
constexpr long double value_of(long double x) { return x; }

/// How many numbers a value has side by side, and one of them: more than one has Batch (core/scalars/batch.hpp).
template <class T> constexpr int lanes_in(const T& value) {
  if constexpr (std::is_arithmetic_v<T>)
    return 1;
  else
    return lanes_in(value_of(value));
}
template <class T> constexpr double in_lane(const T& value, int lane) {
  if constexpr (std::is_arithmetic_v<T>)
    return double(value);
  else
    return in_lane(value_of(value), lane);  // a derivative of a derivative
}

/// a where the condition holds, b elsewhere: what formulas write in place of a branch, so that they serve scalars with
/// lanes (core/scalars/batch.hpp) too, lane by lane. Both are evaluated.
template <class S> LAGROID_INLINE constexpr S select(bool condition, const S& a, const std::type_identity_t<S>& b) {
  return condition ? a : b;
}

/// What a comparison of two S yields: bool, or one of each lane.
template <class S> struct MaskOfScalar { using Type = bool; };
template <class S>
requires requires { typename S::Mask; }
struct MaskOfScalar<S> {
  using Type = typename S::Mask;
};
template <class S> using MaskOf = typename MaskOfScalar<S>::Type;

/// f<0>(), f<1>(), ..., f<N - 1>().
template <int N, class F> LAGROID_INLINE constexpr void unrolled(const F& f) {
  [&]<int... I>(std::integer_sequence<int, I...>) { (f.template operator()<I>(), ...); }
  (std::make_integer_sequence<int, N>{});
}

/// The numbers of x, in its order, as a vector or matrix A over any scalar that they convert to. Entry by entry: every
/// expression of Eigen's is a class for each scalar and size (docs/decisions/72_expressions_cost_their_square.md).
template <class A, class X> A with_entries_of(const X& x) {
  A out;
  unrolled<A::SizeAtCompileTime>([&]<int I>() {
    out.coeffRef(I) = Eigen::internal::cast_impl<typename X::Scalar, typename A::Scalar>::run(x.coeff(I));
  });
  return out;
}

}  // namespace lagroid
