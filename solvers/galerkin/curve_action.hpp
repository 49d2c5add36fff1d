#pragma once
/// The action of a polynomial curve of arrows, h sum_i b_i l(q(c_i), xi(c_i)) along t -> tau(q, x(t)), with its
/// derivatives in the inner nodes of x.
///
/// Both ways to be rid of the inner nodes use it: to solve for them inside (Galerkin), and to keep them beside the
/// arrow (GalerkinOnNodes).
///
///     const CurveAction<Drop, 3, CurveQuadrature::gauss> action{lagrangian, groupoid};
///     const Vector<double, 2> between = action.straight(end);         // inner nodes on a straight line in the chart
///     const double size = action.value(q, end, between, /*h*/ 0.1);
///
/// Requires a chart that holds the curve. Refers to the Lagrangian and the groupoid. Returns numbers over the scalar of
/// its arguments; nothing is allocated, nothing throws.
///
/// Source: Marsden and West, Acta Numerica 10 (2001), 2.2.6.

#include <lagroid/core/continuous/continuous_lagrangian.hpp>
#include <lagroid/core/continuous/curve_point.hpp>
#include <lagroid/core/continuous/curve_rule.hpp>
#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/derivatives/implicit.hpp>
#include <lagroid/core/scalars/second_jet.hpp>

#include <cmath>
#include <string>

namespace lagroid {

/// x(t), t in [0, 1], is the polynomial of degree `Degree` through 0, the inner nodes `between` and `end`, at the nodes
/// of Lobatto; `step` is the time of the whole.
template <class L, int Degree, CurveQuadrature Points> struct CurveAction {
  using G = typename L::GroupoidType;
  using Rule = CurveRule<Degree, Points>;
  static constexpr int n = L::dimension;
  static constexpr int inner_nodes = Degree - 1;
  static constexpr int inner = n * inner_nodes;
  template <class S> using Inner = Vector<S, inner>;
  template <class S> using Coordinates = Vector<S, n>;

  const L& lagrangian;
  const G& groupoid;

  static std::string name() {
    return (Points == CurveQuadrature::gauss ? "Gauss " : "Lobatto ") + std::to_string(Rule::points);
  }

  /// Inner nodes on the straight line to `end`.
  template <class S> static Inner<S> straight(const Coordinates<S>& end) {
    Inner<S> between;
    for (int j = 0; j < inner_nodes; ++j)
      for (int k = 0; k < n; ++k) between(j * n + k) = end(k) * Rule::rule().curve_node[std::size_t(j + 1)];
    return between;
  }

  /// The point of AG at point i of the quadrature.
  template <class S, class Q>
  CurvePoint<G, S> point(std::size_t i, const Q& q, const Coordinates<S>& end, const Inner<S>& between,
                         const S& step) const {
    const auto& rule = Rule::rule();
    return curve_point<S>(groupoid, q, combination(rule.value[i], end, between),
                          Coordinates<S>(combination(rule.derivative[i], end, between) / step));
  }

  template <class S, class Q>
  S value(const Q& q, const Coordinates<S>& end, const Inner<S>& between, const S& step) const {
    S sum(0.0);
    for (std::size_t i = 0; i < std::size_t(Rule::points); ++i) {
      const CurvePoint<G, S> at = point<S>(i, q, end, between, step);
      sum += lagrangian.l(at.object, at.velocity) * Rule::rule().weight[i];
    }
    return sum * step;
  }

  /// The derivative in the inner nodes.
  template <class S, class Q>
  Inner<S> gradient(const Q& q, const Coordinates<S>& end, const Inner<S>& between, const S& step) const {
    using D = Dual<S>;
    const auto& rule = Rule::rule();
    const auto from = groupoid.template cast_object<D>(q);
    Inner<S> out = constants<S>(Vector<double, inner>(Vector<double, inner>::Zero()));
    for (std::size_t i = 0; i < std::size_t(Rule::points); ++i) {
      const auto both = joined<S, n, n>(combination(rule.value[i], end, between),
                                        Coordinates<S>(combination(rule.derivative[i], end, between) / step));
      const Vector<S, 2 * n> slope = gradient_of([&](const Vector<D, 2 * n>& y) { return density(from, y); }, both);
      for (std::size_t j = 0; j < std::size_t(inner_nodes); ++j)
        for (int k = 0; k < n; ++k)
          out(int(j) * n + k) += slope(k) * step * (rule.weight[i] * rule.value[i][j + 1]) +
                                 slope(n + k) * (rule.weight[i] * rule.derivative[i][j + 1]);
    }
    return out;
  }

  /// The same with its derivative, for a Newton iteration: F = 0 where the curve is stationary.
  detail::EquationsAt<inner> equations(const ObjectOf<G>& q, const Coordinates<double>& end,
                                       const Inner<double>& between, double step) const {
    using J = SecondJet<double, 2 * n>;
    const auto& rule = Rule::rule();
    const auto from = groupoid.template cast_object<J>(q);
    detail::EquationsAt<inner> out;
    Inner<double> terms;
    for (int a = 0; a < inner; ++a) out.value(a) = terms(a) = 0;
    for (int a = 0; a < inner * inner; ++a) out.jacobian(a) = 0;
    for (std::size_t i = 0; i < std::size_t(Rule::points); ++i) {
      const Coordinates<double> x = combination(rule.value[i], end, between);
      const Coordinates<double> rate = combination(rule.derivative[i], end, between) / step;
      Vector<J, 2 * n> y;
      for (int k = 0; k < n; ++k) {
        y(k) = J::variable(x(k), k);
        y(n + k) = J::variable(rate(k), n + k);
      }
      const J f = density(from, y);
      const double b = rule.weight[i] * step;
      for (std::size_t j = 0; j < std::size_t(inner_nodes); ++j) {
        const double at_j = rule.value[i][j + 1];
        const double rate_j = rule.derivative[i][j + 1] / step;
        for (int k = 0; k < n; ++k) {
          const int row = int(j) * n + k;
          const double by_place = b * at_j * f.gradient(k);
          const double by_rate = b * rate_j * f.gradient(n + k);
          out.value(row) += by_place + by_rate;
          terms(row) += std::abs(by_place) + std::abs(by_rate);
          for (std::size_t m = 0; m < std::size_t(inner_nodes); ++m) {
            const double at_m = rule.value[i][m + 1];
            const double rate_m = rule.derivative[i][m + 1] / step;
            for (int c = 0; c < n; ++c)
              out.jacobian(row, int(m) * n + c) +=
                  b * (at_j * (at_m * f.hessian(k, c) + rate_m * f.hessian(k, n + c)) +
                       rate_j * (at_m * f.hessian(n + k, c) + rate_m * f.hessian(n + k, n + c)));
          }
        }
      }
    }
    for (int a = 0; a < inner; ++a) out.measure(a, terms(a));
    return out;
  }

 private:
  /// sum_j w_j x_j over the nodes after the first, where the curve is at zero.
  template <class Weights, class S>
  static Coordinates<S> combination(const Weights& weights, const Coordinates<S>& end, const Inner<S>& between) {
    Coordinates<S> out;
    for (int k = 0; k < n; ++k) {
      out(k) = end(k) * weights[std::size_t(Degree)];
      for (std::size_t j = 0; j < std::size_t(inner_nodes); ++j) out(k) += between(int(j) * n + k) * weights[j + 1];
    }
    return out;
  }
  /// l at the point of AG with chart coordinates and their rates y = (x, x').
  template <class S, class Q> S density(const Q& q, const Vector<S, 2 * n>& y) const {
    const CurvePoint<G, S> at = curve_point<S>(groupoid, q, part<0, n>(y), part<n, n>(y));
    return lagrangian.l(at.object, at.velocity);
  }
};

}  // namespace lagroid
