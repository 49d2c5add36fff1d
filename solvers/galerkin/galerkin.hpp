#pragma once
/// Discrete Lagrangians of order two to ten of any continuous one: the action of the best polynomial curve,
///
///     L(g) = ext over x_1 ... x_{s-1} of  h sum_i b_i l(q(c_i), xi(c_i)),    q, xi along t -> tau(alpha(g), x(t)),
///
/// x(t) the polynomial of degree s through 0, x_1, ..., x_{s-1}, tau^{-1}(g), and b, c the s points of Gauss or the
/// s + 1 of Lobatto. The order is 2 s, of a single step, forwards. With s points of Lobatto it is the pair Lobatto
/// IIIA-IIIB, of order 2 s - 2, whose curves keep constraints of objects at each of these points.
///
///     struct Drop : ContinuousLagrangian<Pair<1>> {
///       template <class S> S l(const Vector<S, 1>& q, const Vector<S, 1>& v) const { return v(0) * v(0) * 0.5 - q(0);
///       }
///     };
///     inline const Galerkin<Drop, 3> system{Drop{}, /*h*/ 0.2};  // of order six
///
/// Requires an l that is smooth and regular along the curve. Constraints of arrows are taken by GalerkinOnNodes
/// (galerkin_on_nodes.hpp), those of objects by `lobatto_pair` alone. The inner nodes, and the multipliers there, are
/// solved for inside every evaluation, at a fixed size and without allocation, and the result has its derivatives over
/// any scalar.
///
/// Errors: where the inner solve does not converge, the Lagrangian is not a number, so that a step ends with
/// `not_finite` and is not taken; where l is degenerate it is the inner solve that fails. Nothing throws.
///
/// Source: Marsden and West, Acta Numerica 10 (2001), 2.2.6; Leok and Shingel, IMA J. Numer. Anal. 32 (2012); Hall and
/// Leok, Numer. Math. 130 (2015), and Found. Comput. Math. 17 (2017) for Lie groups; Jay, SIAM J. Numer. Anal. 33
/// (1996), for the pair.

#include <lagroid/core/continuous/curve_point.hpp>
#include <lagroid/core/continuous/curve_rule.hpp>
#include <lagroid/core/continuous/discretised_lagrangian.hpp>
#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/solvers/galerkin/curve_action.hpp>
#include <lagroid/solvers/methods/method.hpp>

#include <cmath>
#include <limits>

namespace lagroid {

namespace detail {

/// The action of the best curve of degree `Degree`. Derived says whether a curve that was found is good enough,
/// `accepts(end, between)`.
template <class Derived, class L, int Degree, CurveQuadrature Points>
struct BestCurve : DiscretisedLagrangian<Derived, L> {
  using Common = DiscretisedLagrangian<Derived, L>;
  using G = typename L::GroupoidType;
  using Action = CurveAction<L, Degree, Points>;
  using Common::Common, Common::h;
  static constexpr int n = L::dimension;
  static constexpr int inner = Action::inner;
  template <class A> using ScalarOf = ArrowScalar<G, A>;

  template <class A, class T> ScalarOf<A> lagrangian(const A& g, const T& step) const {
    using S = ScalarOf<A>;
    const Action action{this->continuous(), this->groupoid};
    const auto q = this->groupoid.source(g);
    const Vector<S, n> x = this->groupoid.tau_inverse(g);
    const S over = S(step);
    return action.value(q, x, nodes(action, q, x, over), over);
  }
  template <class A> ScalarOf<A> lagrangian(const A& g) const { return lagrangian(g, h); }

  /// The inner nodes x_1 ... x_{s-1} of the curve along g, one after another, and the multipliers of object constraints
  /// at each inner point. Not numbers where they were not found.
  Vector<double, inner> nodes(const ArrowOf<G>& g) const {
    const Action action{this->continuous(), this->groupoid};
    const auto q = this->groupoid.source(g);
    const Vector<double, n> x = this->groupoid.tau_inverse(g);
    return nodes(action, q, x, h);
  }

 private:
  /// Over S, with as many infinitesimals as the value of the action needs. The nodes being stationary, an error e of
  /// theirs is one of e^2 in the action: first derivatives are those at fixed nodes, and each correction of the nodes
  /// is right to one order more.
  template <class S, class Q>
  Vector<S, inner> nodes(const Action& action, const Q& q, const Vector<S, n>& x, const S& step) const {
    Vector<double, n> end;
    for (int i = 0; i < n; ++i) end(i) = number_of(x(i));
    const auto c = this->groupoid.coordinates_of_object(q);
    Vector<double, G::object_coordinate_count()> start;
    for (int i = 0; i < start.size(); ++i) start(i) = number_of(c(i));
    auto root = detail::newton_iteration<inner>(
        [&, over = number_of(step), from = this->groupoid.template object_at<double>(start)](
            const Vector<double, inner>& between) { return action.equations(from, end, between, over); },
        Action::straight(end));
    if (!static_cast<const Derived&>(*this).accepts(end, root.x))
      for (double& each : root.x) each = std::numeric_limits<double>::quiet_NaN();
    return detail::with_infinitesimals<S, inner>(
        root, [&](const Vector<S, inner>& between) { return action.gradient(q, x, between, step); }, nilpotency<S> / 2);
  }
};

}  // namespace detail

/// The discrete Lagrangian of the curves of degree `Degree` with the quadrature `Points`, of order 2 Degree, or 2
/// Degree
/// - 2 of the pair.
template <class L, int Degree, CurveQuadrature Points = CurveQuadrature::gauss>
struct Galerkin : detail::BestCurve<Galerkin<L, Degree, Points>, L, Degree, Points> {
  static_assert(Degree >= 2, "without inner nodes it is the rule of order two: Midpoint or Trapezoidal");
  static_assert(
      L::arrow_constraints == 0,
      "a curve with inner nodes would keep the constraints of arrows at its ends alone: GalerkinOnNodes keeps "
      "them at every point");
  static_assert(L::object_constraints == 0 || Points == CurveQuadrature::lobatto_pair,
                "a curve with these points would leave the objects that are allowed: for object constraints take "
                "CurveQuadrature::lobatto_pair");
  using Curve = detail::BestCurve<Galerkin, L, Degree, Points>;
  using Curve::Curve;

  static MethodTraits traits() {
    constexpr bool symmetric = retraction_kind_of<typename L::GroupoidType>() == RetractionKind::translation;
    return {Curve::Action::name(), Curve::Action::order, symmetric, true, false};
  }
  template <class End, class Between> static bool accepts(const End&, const Between&) { return true; }
};

}  // namespace lagroid
