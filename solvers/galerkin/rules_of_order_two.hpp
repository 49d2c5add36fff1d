#pragma once
/// Discrete Lagrangians of order two of a continuous one, along the curve t -> tau(alpha(g), t tau^{-1}(g)):
///
///     midpoint      L(g) = h l(q(1/2), xi),                     phi(g) = h psi(q(1/2), xi),
///     trapezoidal   L(g) = h (l(q(0), xi) + l(q(1), xi)) / 2,   phi(g) = h (psi(q(0), xi) + psi(q(1), xi)) / 2,
///
/// q(t) the object where the curve is, and xi its velocity tau^{-1}(g) / h, one for the whole step. They take any
/// constraints, of arrows and objects.
///
///     struct Drop : ContinuousLagrangian<Pair<1>> {
///       template <class S> S l(const Vector<S, 1>& q, const Vector<S, 1>& v) const { return v(0) * v(0) * 0.5 - q(0);
///       }
///     };
///     inline const Midpoint<Drop> system{Drop{}, /*h*/ 0.1};
///
/// Where nothing is known of the retraction (RetractionKind::any), one velocity for the step would be of order one, and
/// xi(t) is the curve's own at each of these points. On the pair groupoid the trapezoidal rule of a kinetic energy and
/// a potential is Stormer-Verlet; the factor h of phi makes its multipliers those of the continuous problem ([G] 6.1).
/// A degenerate l is the step's `singular`. Nothing throws.
///
/// Source: Marsden and West, *Discrete mechanics and variational integrators*, Acta Numerica 10 (2001), 2.6; [G] 6.1.

#include <lagroid/core/continuous/curve_point.hpp>
#include <lagroid/core/continuous/discretised_lagrangian.hpp>
#include <lagroid/solvers/methods/method.hpp>

#include <type_traits>

namespace lagroid {

namespace detail {

/// Derived writes mean(f, g, v, rate), the quadrature of f(q, xi) along the curve tau(alpha(g), t v), v = rate h.
template <class Derived, class L> struct RuleOfOrderTwo : DiscretisedLagrangian<Derived, L> {
  using Common = DiscretisedLagrangian<Derived, L>;
  using Common::Common, Common::h;
  template <class A> using ScalarOf = ArrowScalar<typename L::GroupoidType, A>;
  static constexpr int m = L::arrow_constraints;
  static constexpr RetractionKind kind = retraction_kind_of<typename L::GroupoidType>();

  template <class A, class T> ScalarOf<A> lagrangian(const A& g, const T& step) const {
    return mean_of(g, step, [this](const auto& q, const auto& xi) { return this->l(q, xi); });
  }
  template <class A> ScalarOf<A> lagrangian(const A& g) const { return lagrangian(g, h); }
  template <class A, class T> Vector<ScalarOf<A>, m> constraint(const A& g, const T& step) const requires(m > 0) {
    return mean_of(g, step, [this](const auto& q, const auto& xi) { return this->psi(q, xi); });
  }
  template <class A> Vector<ScalarOf<A>, m> constraint(const A& g) const requires(m > 0) { return constraint(g, h); }

 protected:
  /// The velocity of the curve at x = t v, of which the rate is that in the chart.
  template <class Q, class V> V velocity(const Q& q, const V& x, const V& rate) const {
    using G = typename L::GroupoidType;
    if constexpr (kind == RetractionKind::any) {
      return curve_point<typename V::Scalar, G>(this->groupoid, q, x, rate).velocity;
    } else {
      return rate;
    }
  }

 private:
  template <class A, class T, class F> auto mean_of(const A& g, const T& step, const F& f) const {
    using V = Vector<ScalarOf<A>, Common::n>;
    const V v = this->groupoid.tau_inverse(g);
    V rate;
    for (int i = 0; i < Common::n; ++i) rate(i) = v(i) / step;
    const auto mean = static_cast<const Derived&>(*this).mean(f, g, v, rate);
    return std::remove_const_t<decltype(mean)>(mean * step);
  }
};

}  // namespace detail

/// L(g) = h l(q, xi), q halfway.
template <class L> struct Midpoint : detail::RuleOfOrderTwo<Midpoint<L>, L> {
  using detail::RuleOfOrderTwo<Midpoint<L>, L>::RuleOfOrderTwo;

  /// Self-adjoint where the middle of an arrow is that of its inverse.
  static MethodTraits traits() {
    constexpr bool no_objects = object_dimension_of<typename L::GroupoidType>() == 0;
    constexpr bool symmetric = Midpoint::kind >= (no_objects ? RetractionKind::symmetric : RetractionKind::exponential);
    return {"midpoint", 2, symmetric, true, false};
  }

  template <class F, class A, class V> auto mean(const F& f, const A& g, const V& v, const V& rate) const {
    using Q = typename L::template Object<typename V::Scalar>;
    const V half(v * 0.5);
    const Q from = this->groupoid.source(g);
    Q middle;
    if constexpr (object_dimension_of<typename L::GroupoidType>() > 0)
      middle = this->groupoid.target(this->groupoid.tau(from, half));
    const auto value = f(middle, this->velocity(from, half, rate));
    return value;
  }
};

/// L(g) = h (l(q0, xi) + l(q1, xi)) / 2.
template <class L> struct Trapezoidal : detail::RuleOfOrderTwo<Trapezoidal<L>, L> {
  using detail::RuleOfOrderTwo<Trapezoidal<L>, L>::RuleOfOrderTwo;

  static MethodTraits traits() {
    return {"trapezoidal", 2, Trapezoidal::kind >= RetractionKind::symmetric, true, false};
  }

  template <class F, class A, class V> auto mean(const F& f, const A& g, const V& v, const V& rate) const {
    const auto from = this->groupoid.source(g);
    const auto first = f(from, this->velocity(from, V(v * 0.0), rate));
    const auto second = f(this->groupoid.target(g), this->velocity(from, v, rate));
    return std::remove_const_t<decltype(first)>((first + second) * 0.5);
  }
};

}  // namespace lagroid
