#pragma once
/// Discrete Lagrangians of order two of a continuous one, with one velocity xi = tau^{-1}(g) / h for a whole step:
///
///     midpoint      L(g) = h l(q(1/2), xi),                     phi(g) = h psi(q(1/2), xi),
///     trapezoidal   L(g) = h (l(q(0), xi) + l(q(1), xi)) / 2,   phi(g) = h (psi(q(0), xi) + psi(q(1), xi)) / 2,
///
/// q(t) the object where tau(alpha(g), t h xi) ends. They take any constraints, of arrows and objects.
///
///     struct Drop : ContinuousLagrangian<Pair<1>> {
///       template <class S> S l(const Vector<S, 1>& q, const Vector<S, 1>& v) const { return v(0) * v(0) * 0.5 - q(0);
///       }
///     };
///     inline const Midpoint<Drop> system{Drop{}, /*h*/ 0.1};
///
/// Requires tau^{-1} = log up to terms of third order, as exponential, Cayley and translation are. On the pair groupoid
/// the trapezoidal rule of a kinetic energy and a potential is Stormer-Verlet; the factor h of phi makes its
/// multipliers those of the continuous problem ([G] 6.1). A degenerate l is the step's `singular`. Nothing throws.
///
/// Source: Marsden and West, *Discrete mechanics and variational integrators*, Acta Numerica 10 (2001), 2.6; [G] 6.1.

#include <lagroid/core/continuous/curve_point.hpp>
#include <lagroid/core/continuous/discretised_lagrangian.hpp>
#include <lagroid/solvers/methods/method.hpp>

#include <type_traits>

namespace lagroid {

namespace detail {

/// Derived writes mean(f, g, xi), the quadrature over an arrow of f(q, xi).
template <class Derived, class L> struct RuleOfOrderTwo : DiscretisedLagrangian<Derived, L> {
  using Common = DiscretisedLagrangian<Derived, L>;
  using Common::Common, Common::h;
  template <class A> using ScalarOf = ArrowScalar<typename L::GroupoidType, A>;
  static constexpr int m = L::arrow_constraints;

  template <class A, class T> ScalarOf<A> lagrangian(const A& g, const T& step) const {
    return mean_of(g, step, [this](const auto& q, const auto& xi) { return this->l(q, xi); });
  }
  template <class A> ScalarOf<A> lagrangian(const A& g) const { return lagrangian(g, h); }
  template <class A, class T> Vector<ScalarOf<A>, m> constraint(const A& g, const T& step) const requires(m > 0) {
    return mean_of(g, step, [this](const auto& q, const auto& xi) { return this->psi(q, xi); });
  }
  template <class A> Vector<ScalarOf<A>, m> constraint(const A& g) const requires(m > 0) { return constraint(g, h); }

 private:
  template <class A, class T, class F> auto mean_of(const A& g, const T& step, const F& f) const {
    using V = Vector<ScalarOf<A>, Common::n>;
    const V v = this->groupoid.tau_inverse(g);
    V xi;
    for (int i = 0; i < Common::n; ++i) xi(i) = v(i) / step;
    const auto mean = static_cast<const Derived&>(*this).mean(f, g, v, xi);
    return std::remove_const_t<decltype(mean)>(mean * step);
  }
};

}  // namespace detail

/// L(g) = h l(q, xi), q halfway.
template <class L> struct Midpoint : detail::RuleOfOrderTwo<Midpoint<L>, L> {
  using detail::RuleOfOrderTwo<Midpoint<L>, L>::RuleOfOrderTwo;

  /// Self-adjoint where the middle of an arrow is that of its inverse.
  static MethodTraits traits() {
    constexpr bool symmetric = object_dimension_of<typename L::GroupoidType>() == 0 ||
                               retraction_kind_of<typename L::GroupoidType>() != RetractionKind::any;
    return {"midpoint", 2, symmetric, true, false};
  }

  template <class F, class A, class V> auto mean(const F& f, const A& g, const V& v, const V& xi) const {
    using Q = typename L::template Object<typename V::Scalar>;
    Q middle;
    if constexpr (object_dimension_of<typename L::GroupoidType>() > 0)
      middle = this->groupoid.target(this->groupoid.tau(this->groupoid.source(g), V(v * 0.5)));
    const auto value = f(middle, xi);
    return value;
  }
};

/// L(g) = h (l(q0, xi) + l(q1, xi)) / 2.
template <class L> struct Trapezoidal : detail::RuleOfOrderTwo<Trapezoidal<L>, L> {
  using detail::RuleOfOrderTwo<Trapezoidal<L>, L>::RuleOfOrderTwo;

  static MethodTraits traits() { return {"trapezoidal", 2, true, true, false}; }

  template <class F, class A, class V> auto mean(const F& f, const A& g, const V&, const V& xi) const {
    const auto first = f(this->groupoid.source(g), xi);
    const auto second = f(this->groupoid.target(g), xi);
    return std::remove_const_t<decltype(first)>((first + second) * 0.5);
  }
};

}  // namespace lagroid
