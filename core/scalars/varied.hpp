#pragma once
/// A number with its derivatives in K directions, x + t_1 e_1 + ... + t_K e_K, e_i e_j = 0, and the parameters of a
/// system as such numbers.
///
/// Derivatives along the ends of an arrow are those of jets; with respect to a mass or a length they need a scalar
/// beside these, in whose stead a formula that reads its parameters by `varied` computes.
///
///     template <class S> S potential(const Vector<S, 1>& q) const {
///       return cos(q(0)) * (varied<S>(mass) * varied<S>(gravity) * varied<S>(length) * -1.0);
///     }
///
/// Requires of `varied` a member itself, not a copy: it is known by its place. Returns the member, a plain number,
/// unless S is a Varied, a jet of such or nested over one; then the member with the directions in which a VariedMembers
/// that lives on this thread varies it. A step is compiled without any of it. Nothing throws.

#include <lagroid/core/scalars/dual.hpp>
#include <lagroid/core/scalars/hyper_dual.hpp>
#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/core/scalars/series.hpp>
#include <lagroid/core/types.hpp>

#include <span>
#include <type_traits>

namespace lagroid {

/// x with K derivatives: Jet<double, K>, of a type of its own, so that a jet of it is told from others.
template <int K> class Varied : public ScalarOperators<Varied<K>, double> {
 public:
  using Real = double;
  static constexpr int order = 1;
  static constexpr int directions = K;
  using Tangent = Pack<double, K>;

  double value;

  Varied() = default;
  /// A constant. Implicit, so that formulas may contain plain numbers.
  template <class A>
  requires std::is_arithmetic_v<A> Varied(A x) : value(double(x)), tangent_{} {}  // NOLINT(google-explicit-constructor)
  LAGROID_INLINE Varied(double x, const Tangent& tangent) : value(x), tangent_(tangent) {}

  /// x, varied in direction i.
  LAGROID_INLINE static Varied variable(double x, int i) { return {x, Tangent::unit(i)}; }
  double tangent(int i) const { return tangent_[i]; }

  /// The composition with a function of one variable, given its value and derivatives at `value`.
  LAGROID_INLINE Varied chain(double f, double f1, double /*f2*/) const { return {f, f1 * tangent_}; }

  LAGROID_INLINE friend Varied select(bool condition, const Varied& a, const Varied& b) { return condition ? a : b; }
  LAGROID_INLINE friend Varied operator-(const Varied& a) { return {-a.value, -a.tangent_}; }
  LAGROID_INLINE friend Varied operator+(const Varied& a, const Varied& b) {
    return {a.value + b.value, a.tangent_ + b.tangent_};
  }
  LAGROID_INLINE friend Varied operator-(const Varied& a, const Varied& b) {
    return {a.value - b.value, a.tangent_ - b.tangent_};
  }
  LAGROID_INLINE friend Varied operator*(const Varied& a, const Varied& b) {
    return {a.value * b.value, a.value * b.tangent_ + b.value * a.tangent_};
  }
  LAGROID_INLINE friend Varied operator/(const Varied& a, const Varied& b) {
    const double inverse = 1 / b.value;
    const double quotient = a.value * inverse;
    return {quotient, inverse * (a.tangent_ - quotient * b.tangent_)};
  }
  LAGROID_INLINE friend Varied operator+(const Varied& a, double b) { return {a.value + b, a.tangent_}; }
  LAGROID_INLINE friend Varied operator*(const Varied& a, double b) { return {a.value * b, b * a.tangent_}; }
  LAGROID_INLINE friend Varied operator/(double a, const Varied& b) {
    const double inverse = 1 / b.value;
    return {a * inverse, (-a * inverse * inverse) * b.tangent_};
  }

 private:
  Tangent tangent_;
};

template <int K> constexpr double value_of(const Varied<K>& x) { return x.value; }

/// Of all orders that a jet of varied numbers asks for.
template <int Order, int K> Varied<K> angle_ratio(const Varied<K>& w) {
  return w.chain(angle_ratio<Order>(w.value), angle_ratio<Order + 1>(w.value), 0);
}

/// While it lives, `varied` finds on this thread that the members at these places are varied: place i in direction
/// first + i. A place is that of a member of the very system that is evaluated; copies of it are constants.
class VariedMembers {
 public:
  VariedMembers(std::span<const double* const> places, int first) : places_(places), first_(first), before_(now_) {
    now_ = this;
  }
  ~VariedMembers() { now_ = before_; }
  VariedMembers(const VariedMembers&) = delete;
  VariedMembers& operator=(const VariedMembers&) = delete;

  /// The direction of a member, or -1.
  static int direction_of(const double& member) {
    if (now_ == nullptr) return -1;
    for (std::size_t i = 0; i < now_->places_.size(); ++i)
      if (now_->places_[i] == &member) return now_->first_ + int(i);
    return -1;
  }

 private:
  std::span<const double* const> places_;
  int first_;
  const VariedMembers* before_;
  static inline thread_local const VariedMembers* now_ = nullptr;
};

namespace detail {

/// The scalar of parameters in a formula over S.
template <class S> struct ParameterScalar { using Type = double; };
template <int K> struct ParameterScalar<Varied<K>> { using Type = Varied<K>; };
template <int K, int N> struct ParameterScalar<Jet<Varied<K>, N>> { using Type = Varied<K>; };
template <int K, int L, int R> struct ParameterScalar<HyperDual<Varied<K>, L, R>> { using Type = Varied<K>; };
/// Scalars that nest to any depth mix with no other: what is varied in them is a constant of the whole.
template <class S, class Inner>
using NestedParameter = std::conditional_t<std::is_same_v<typename ParameterScalar<Inner>::Type, double>, double, S>;
template <class T> struct ParameterScalar<Dual<T>> { using Type = NestedParameter<Dual<T>, T>; };
template <class T, int K> struct ParameterScalar<Series<T, K>> { using Type = NestedParameter<Series<T, K>, T>; };

/// A member as a number with derivatives, P a ParameterScalar.
template <class P> struct VariedMember;
template <int K> struct VariedMember<Varied<K>> {
  static Varied<K> of(const double& member) {
    const int direction = VariedMembers::direction_of(member);
    return 0 <= direction && direction < K ? Varied<K>::variable(member, direction) : Varied<K>(member);
  }
};
/// Of a jet or a hyper-dual number over a Varied.
template <class S> struct VariedValue {
  static S of(const double& member) {
    S out(0.0);
    out.value = VariedMember<decltype(out.value)>::of(member);
    return out;
  }
};
template <int K, int N> struct VariedMember<Jet<Varied<K>, N>> : VariedValue<Jet<Varied<K>, N>> {};
template <int K, int L, int R>
struct VariedMember<HyperDual<Varied<K>, L, R>> : VariedValue<HyperDual<Varied<K>, L, R>> {};
template <class T> struct VariedMember<Dual<T>> {
  static Dual<T> of(const double& member) { return Dual<T>(VariedMember<T>::of(member)); }
};
template <class T, int K> struct VariedMember<Series<T, K>> {
  static Series<T, K> of(const double& member) { return Series<T, K>(VariedMember<T>::of(member)); }
};

}  // namespace detail

template <class S> using ParameterScalar = typename detail::ParameterScalar<S>::Type;

/// A member of a system in a formula over S: the number itself, with its derivatives where S asks for them.
template <class S> LAGROID_INLINE inline ParameterScalar<S> varied(const double& member) {
  if constexpr (std::is_same_v<ParameterScalar<S>, double>) {
    return member;
  } else {
    return detail::VariedMember<ParameterScalar<S>>::of(member);
  }
}
template <class S> double varied(double&& copy) = delete;

/// The same of a vector.
template <class S, int N> LAGROID_INLINE inline decltype(auto) varied(const Vector<double, N>& member) {
  if constexpr (std::is_same_v<ParameterScalar<S>, double>) {
    return (member);
  } else {
    Vector<ParameterScalar<S>, N> out;
    for (int i = 0; i < N; ++i) out(i) = varied<S>(member.data()[i]);
    return out;
  }
}

/// x, a plain number, a parameter or an S, as an S: a constant of a formula over S.
template <class S, class X> LAGROID_INLINE inline S constant(const X& x) {
  if constexpr (std::is_same_v<S, X> || std::is_arithmetic_v<X>) {
    return S(x);
  } else {
    S out(0);
    out.value = x;
    return out;
  }
}

}  // namespace lagroid

/// Arrows over varied numbers become constants of jets of them.
template <int K, class X>
requires std::is_same_v<lagroid::ParameterScalar<X>, lagroid::Varied<K>> &&
    (!std::is_same_v<X, lagroid::Varied<K>>)struct Eigen::internal::cast_impl<lagroid::Varied<K>, X> {
  static X run(const lagroid::Varied<K>& x) { return lagroid::constant<X>(x); }
};
