#pragma once
/// Discrete Lagrangians of high order of a continuous one with arrow constraints: the curve of a step is a polynomial
/// x(t) of degree s in the chart of the retraction, and keeps psi = 0 at each of the s points of Gauss,
///
///     L(g, x) = h sum_i b_i l(q(c_i), xi(c_i)),    phi_i(g, x) = h b_i psi(q(c_i), xi(c_i)) = 0,    i = 1 ... s.
///
/// The inner nodes x are part of the arrows (inner_nodes.hpp), so that a step solves for them and for all multipliers.
///
///     struct Skate : ContinuousLagrangian<SE2, 1> {  // turns and goes ahead, and does not slide
///       template <class S> S l(const Vector<S, 0>&, const Vector<S, 3>& xi) const { return xi.squaredNorm() * 0.5; }
///       template <class S> Vector<S, 1> psi(const Vector<S, 0>&, const Vector<S, 3>& xi) const {
///         return Vector<S, 1>(xi(2));
///       }
///     };
///     inline const GalerkinOnNodes<Skate, 2> system{Skate{}, /*h*/ 0.1};  // of order four
///     inline const auto start = system.extended({{}, {0.3, 1, 0.2}});     // and system.reduced(start), back
///
/// Requires constraints that are vakonomic, and regular with l: the matrix of second derivatives of l + <lambda, psi>
/// in xi, bordered by dpsi/dxi, is one that can be inverted. Then the extremals are a Hamiltonian system on A*G with
/// the multipliers determined, and the step is Gauss's collocation of it in the chart, of order 2 s.
///
/// Errors: where that matrix is singular the step ends with `singular`, and is not taken. Nothing throws.
///
/// Source: [G] section 3 and 6.1; Marsden and West, Acta Numerica 10 (2001), 2.6; Hairer, Lubich, Wanner, *Geometric
/// Numerical Integration*, 2006, VI.6.3.

#include <lagroid/core/continuous/discretised_lagrangian.hpp>
#include <lagroid/core/system.hpp>
#include <lagroid/solvers/galerkin/curve_action.hpp>
#include <lagroid/solvers/galerkin/inner_nodes.hpp>
#include <lagroid/solvers/methods/method.hpp>

namespace lagroid {

/// Of order 2 Degree. Multipliers: those of psi at the first point of Gauss, then at the second, ...; each is that of
/// the continuous problem there.
template <class L, int Degree>
struct GalerkinOnNodes : DiscretisedOnNodes<GalerkinOnNodes<L, Degree>, L, Degree, L::arrow_constraints * Degree> {
  using OnNodes = DiscretisedOnNodes<GalerkinOnNodes, L, Degree, L::arrow_constraints * Degree>;
  using OnNodes::arrow_constraints, OnNodes::base, OnNodes::constraint, OnNodes::continuous, OnNodes::h,
      OnNodes::lagrangian, OnNodes::n, OnNodes::OnNodes;
  using Action = CurveAction<L, Degree, CurveQuadrature::gauss>;
  template <class A> using ScalarOf = typename OnNodes::template ScalarOf<A>;
  static constexpr int each = L::arrow_constraints;

  static MethodTraits traits() {
    return {Action::name(), 2 * Degree, retraction_kind_of<typename L::GroupoidType>() == RetractionKind::translation,
            true, false};
  }
  template <class A, class T> ScalarOf<A> lagrangian(const A& g, const T& step) const {
    using S = ScalarOf<A>;
    const auto& [arrow, between] = g;
    return action().value(base().source(arrow), Vector<S, n>(base().tau_inverse(arrow)), between, S(step));
  }
  template <class A, class T>
  Vector<ScalarOf<A>, arrow_constraints> constraint(const A& g, const T& step) const requires(each > 0) {
    using S = ScalarOf<A>;
    const auto& [arrow, between] = g;
    const auto q = base().source(arrow);
    const Vector<S, n> end = base().tau_inverse(arrow);
    Vector<S, arrow_constraints> phi;
    for (int i = 0; i < Degree; ++i) {
      const auto at = action().template point<S>(std::size_t(i), q, end, between, S(step));
      const Vector<S, each> psi = this->psi(at.object, at.velocity);
      for (int a = 0; a < each; ++a) phi(i * each + a) = psi(a) * S(step) * Action::Rule::rule().weight[std::size_t(i)];
    }
    return phi;
  }

  /// Nodes on a straight line to tau(q, h xi).
  Step<GalerkinOnNodes> first_guess(const State<typename OnNodes::GroupoidType>& s) const {
    const State<typename L::GroupoidType> z = OnNodes::reduced(s);
    const auto [xi, lambda] = velocity_of(continuous(), base(), z);
    Vector<double, n> end = Vector<double, n>::Zero();
    if (xi.allFinite()) end = h * xi;
    Step<GalerkinOnNodes> guess;
    guess.arrow = {base().tau(z.object, end), Action::straight(end)};
    if constexpr (each > 0)
      for (int i = 0; i < arrow_constraints; ++i) guess.multipliers(i) = xi.allFinite() ? lambda(i % each) : 0;
    return guess;
  }

 private:
  Action action() const { return {continuous(), base()}; }
};

}  // namespace lagroid
