#pragma once
/// The principle of Hamilton and Pontryagin on groupoids: velocity xi, momentum pi and arrow g vary independently,
///
///     L(g, xi, pi) = h l(q, xi) + <pi, tau^{-1}(g) - h xi>,
///
/// q where the rule of order two looks, the middle or the ends. Stationary in pi it says tau^{-1}(g) = h xi, in xi the
/// Legendre transform pi = dl/dxi, and in g the discrete Euler-Lagrange equations of the rule. Both need no inverse of
/// the Legendre transform, so that a degenerate l is met by its primary constraint pi = dl/dxi inside of a step.
///
///     struct Orbit : ContinuousLagrangian<Pair<2>> {
///       template <class S> S l(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
///         using std::sqrt;
///         return (v(0) * v(0) + v(1) * v(1)) * 0.5 + 1.0 / sqrt(q(0) * q(0) + q(1) * q(1));
///       }
///     };
///     inline const HamiltonPontryagin<Midpoint<Orbit>> system{Orbit{}, /*h*/ 0.05};
///     inline const auto start = system.extended({{1, 0}, {0, 1}});
///
/// Velocity and momentum are beside the arrow, as inner nodes are (inner_nodes.hpp); constraints of arrows psi(q, xi) =
/// 0 are those of the independent velocity. Requires L without object constraints. Where the equations do not determine
/// the step its status is `singular`. Nothing throws.
///
/// Source: Yoshimura and Marsden, J. Geom. Phys. 57 (2006); Bou-Rabee and Marsden, Found. Comput. Math. 9 (2009), for
/// groups; Stern, J. Symplectic Geom. 8 (2010), for groupoids.

#include <lagroid/core/system.hpp>
#include <lagroid/solvers/galerkin/inner_nodes.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>

namespace lagroid {

/// Of a rule of order two, Midpoint<L> or Trapezoidal<L>. The momentum of velocities and momenta beside the arrow is
/// zero, in `extended`, and stays so: that they are stationary.
template <class Rule>
struct HamiltonPontryagin
    : DiscretisedOnNodes<HamiltonPontryagin<Rule>, typename Rule::Continuous, 3, Rule::arrow_constraints> {
  using L = typename Rule::Continuous;
  // Of the nodes the first is xi, the second pi.
  using OnNodes = DiscretisedOnNodes<HamiltonPontryagin, L, 3, Rule::arrow_constraints>;
  using OnNodes::base, OnNodes::constraint, OnNodes::continuous, OnNodes::h, OnNodes::lagrangian, OnNodes::n,
      OnNodes::OnNodes;
  template <class A> using ScalarOf = typename OnNodes::template ScalarOf<A>;
  static constexpr int m = L::arrow_constraints;

  static MethodTraits traits() {
    MethodTraits traits{"", 2, true, true, false};
    if constexpr (HasTraits<Rule>) traits = Rule::traits();
    traits.name = "Hamilton-Pontryagin";
    return traits;
  }
  template <class A, class T> ScalarOf<A> lagrangian(const A& g, const T& step) const {
    using S = ScalarOf<A>;
    const auto& [arrow, beside] = g;
    const Vector<S, n> xi = part<0, n>(beside);
    const Vector<S, n> pi = part<n, n>(beside);
    const Vector<S, n> moved = base().tau_inverse(arrow);
    S action = mean(arrow, moved, xi, [this](const auto& q, const auto& v) { return this->l(q, v); }) * step;
    for (int i = 0; i < n; ++i) action += pi(i) * (moved(i) - xi(i) * step);
    return action;
  }
  template <class A, class T> Vector<ScalarOf<A>, m> constraint(const A& g, const T& step) const requires(m > 0) {
    using S = ScalarOf<A>;
    const auto& [arrow, beside] = g;
    const Vector<S, n> moved = base().tau_inverse(arrow);
    Vector<S, m> phi = mean(arrow, moved, Vector<S, n>(part<0, n>(beside)),
                            [this](const auto& q, const auto& v) { return this->psi(q, v); });
    for (int a = 0; a < m; ++a) phi(a) = phi(a) * S(step);
    return phi;
  }

  /// tau(q, h xi), with xi of the momentum; at rest where l is degenerate.
  Step<HamiltonPontryagin> first_guess(const State<typename OnNodes::GroupoidType>& s) const {
    const State<typename OnNodes::BaseGroupoid> z = OnNodes::reduced(s);
    auto [xi, lambda] = velocity_of(continuous(), base(), z);
    if (!xi.allFinite()) {
      xi.setZero();
      lambda.setZero();
    }
    Step<HamiltonPontryagin> guess;
    guess.arrow = {base().tau(z.object, Vector<double, n>(h * xi)), joined(xi, z.momentum)};
    guess.multipliers = lambda;
    return guess;
  }

 private:
  /// f(q, xi) where the rule looks.
  template <class A, class V, class F> auto mean(const A& arrow, const V& moved, const V& xi, const F& f) const {
    Rule rule(continuous(), h);
    rule.groupoid = base();
    return rule.mean(f, arrow, moved, xi);
  }
};

}  // namespace lagroid
