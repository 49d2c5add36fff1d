#pragma once
/// The exact discrete Lagrangian of a continuous one, the action of its solution along an arrow,
///
///     L^E(g) = int_0^h l(q(t), xi(t)) dt,    q(0) = alpha(g), q(h) = beta(g), the motion of length h that makes g,
///
/// as a system like any other, whose step is the flow: what the discrete Lagrangians of rules are measured against.
///
///     struct Drop : ContinuousLagrangian<Pair<1>> {
///       template <class S> S l(const Vector<S, 1>& q, const Vector<S, 1>& v) const {
///         return v(0) * v(0) * 0.5 - q(0);
///       }
///     };
///     inline const ExactLagrangian<Drop> flow{Drop{}, /*h*/ 0.5};
///     inline const double term = modified_term(Midpoint<Drop>{}, {}, Vector<double, 1>(1.0)).value;  // 1 / 24
///
/// The boundary value problem is solved on polynomials of degree ten in the chart of the retraction, by Newton's method
/// and Gauss's quadrature, of which the action has twice the digits; with object constraints (holonomic ones) by those
/// of the pair Lobatto IIIA-IIIB.
///
/// Requires an l that is smooth and regular along the solution, and no constraints of arrows (docs/any_lagrangian.md
/// says why). Where two motions of length h join the ends, it is that which Newton's method finds from the straight
/// line in the chart.
///
/// Errors: where the motion bends more in one step than the polynomials follow to round-off, or none is found, the
/// Lagrangian is not a number, so that a step ends with `not_finite` and is not taken: shorten h. Nothing throws.
///
/// Source: [G] 7.2; Marsden and West, Acta Numerica 10 (2001), 1.6; Vermeeren, Numer. Math. 137 (2017), for modified
/// Lagrangians.

#include <lagroid/solvers/galerkin/galerkin.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace lagroid {

namespace detail {
inline constexpr int exact_degree = 10;
template <class L>
inline constexpr CurveQuadrature exact_points =
    L::object_constraints > 0 ? CurveQuadrature::lobatto_pair : CurveQuadrature::gauss;
}  // namespace detail

template <class L>
struct ExactLagrangian : detail::BestCurve<ExactLagrangian<L>, L, detail::exact_degree, detail::exact_points<L>> {
  static_assert(L::arrow_constraints == 0,
                "the action of paths with constraints of arrows is a function of reachable ends alone, and not of all "
                "arrows: take GalerkinOnNodes, whose curves keep the constraints");
  using Curve = detail::BestCurve<ExactLagrangian, L, detail::exact_degree, detail::exact_points<L>>;
  using Curve::Curve;
  static constexpr int n = L::dimension;

  /// Of the polynomials' order where they do not reach round-off, and where they do it is not seen.
  static MethodTraits traits() { return {"exact", Curve::Action::order, true, true, false}; }

  /// Whether the action is known to round-off: its error is the square of that of the velocity, of which the last
  /// Legendre coefficients tell.
  bool accepts(const Vector<double, n>& end, const Vector<double, Curve::inner>& between) const {
    const double last = last_coefficients(end, between);
    return last * last <= std::numeric_limits<double>::epsilon();
  }
  /// The last two Legendre coefficients of x'(t) along g, relative to the largest; the larger of both. Not a number
  /// where no motion was found.
  double unresolved(const ArrowOf<typename L::GroupoidType>& g) const {
    return last_coefficients(this->groupoid.tau_inverse(g), this->nodes(g));
  }

 private:
  static double last_coefficients(const Vector<double, n>& end, const Vector<double, Curve::inner>& between) {
    constexpr std::size_t degree = detail::exact_degree;
    static const GaussNodes<int(degree)> gauss;
    const auto& rule = CurveRule<int(degree), CurveQuadrature::gauss>::rule();
    double largest = 0, last = 0;
    for (std::size_t m = 0; m < degree; ++m)
      for (int k = 0; k < n; ++k) {
        double sum = 0;
        for (std::size_t i = 0; i < degree; ++i) {
          double rate = end(k) * rule.derivative[i][degree];
          for (std::size_t j = 1; j < degree; ++j) rate += between(int(j - 1) * n + k) * rule.derivative[i][j];
          sum += double(2 * m + 1) * gauss.weight[i] * gauss.legendre[m][i] * rate;
        }
        if (std::isnan(sum)) return sum;
        largest = std::max(largest, std::abs(sum));
        if (m + 2 >= degree) last = std::max(last, std::abs(sum));
      }
    return largest > 0 ? last / largest : 0;
  }
};

/// A number that was extrapolated, and what its last digits are known to.
struct ExtrapolatedNumber {
  double value;
  double error;
};

/// L(g) - L^E(g) of a rule with the step h, at g = tau(q, -h xi / 2)^{-1} tau(q, h xi / 2), and the size of L. Not a
/// number where L^E is none there.
struct ActionDifference {
  double value;
  double size;
};
template <class Rule>
ActionDifference action_difference(Rule rule, const ObjectOf<typename Rule::GroupoidType>& q,
                                   const AlgebroidVector<typename Rule::GroupoidType>& xi, double h) {
  ExactLagrangian<typename Rule::Continuous> exact(rule.continuous(), h);
  exact.groupoid = rule.groupoid;
  rule.h = h;
  const AlgebroidVector<typename Rule::GroupoidType> ahead = xi * (h / 2), back = -ahead;
  const auto g = rule.groupoid.multiply(rule.groupoid.inverse(rule.groupoid.tau(q, back)), rule.groupoid.tau(q, ahead));
  const double action = rule.lagrangian(g);
  return {action - exact.lagrangian(g), std::abs(action)};
}

/// The first term of the modified Lagrangian of a rule of order r: its step is, to order r + 1, that of the flow of
///
///     l~ = l + h^r l_r,    l_r(q, xi) = lim (L(g) - L^E(g)) / h^{r+1},
///
/// g as in action_difference, extrapolated from h = `longest` and its halves. Not a number where L^E is none. Vermeeren
/// (2017).
template <class Rule>
ExtrapolatedNumber modified_term(const Rule& rule, const ObjectOf<typename Rule::GroupoidType>& q,
                                 const AlgebroidVector<typename Rule::GroupoidType>& xi, double longest = 0.1) {
  constexpr int levels = 4;
  double table[levels];
  double last = std::numeric_limits<double>::quiet_NaN();
  for (int level = 0; level < levels; ++level) {
    const double h = std::ldexp(longest, -level);
    table[level] = action_difference(rule, q, xi, h).value / std::pow(h, Rule::traits().order + 1);
    last = table[0];
    for (int k = level - 1; k >= 0; --k)
      table[k] = table[k + 1] + (table[k + 1] - table[k]) / (std::ldexp(1, level - k) - 1);
  }
  return {table[0], std::abs(table[0] - last)};
}

}  // namespace lagroid
