#pragma once
/// The action of a polynomial curve of arrows, h sum_i b_i l(q(c_i), xi(c_i)) along t -> tau(q, x(t)), with its
/// derivatives in the inner nodes of x. Where objects are constrained, C(q(c_i)) = 0 at the inner points of the
/// quadrature, and the action is that of l + <lambda_i, C>. From ends off the constraint C goes over from one value to
/// the other, so that the curve stays smooth; of the action of allowed ends that changes nothing.
///
/// Both ways to be rid of the inner nodes use it: to solve for them inside (Galerkin), and to keep them beside the
/// arrow (GalerkinOnNodes).
///
///     const CurveAction<Drop, 3, CurveQuadrature::gauss> action{lagrangian, groupoid};
///     const Vector<double, 2> between = action.straight(end);         // inner nodes on a straight line in the chart
///     const double size = action.value(q, end, between, /*h*/ 0.1);
///
/// Requires a chart that holds the curve, and of object constraints Lobatto's points of the pair IIIA-IIIB. Refers to
/// the Lagrangian and the groupoid. Returns numbers over the scalar of its arguments; nothing is allocated, nothing
/// throws.
///
/// Source: Marsden and West, Acta Numerica 10 (2001), 2.2.6, 2.6.5; Jay, SIAM J. Numer. Anal. 33 (1996), for the pair
/// with constraints.

#include <lagroid/core/continuous/continuous_lagrangian.hpp>
#include <lagroid/core/continuous/curve_point.hpp>
#include <lagroid/core/continuous/curve_rule.hpp>
#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/derivatives/implicit.hpp>
#include <lagroid/core/scalars/second_jet.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace lagroid {

/// x(t), t in [0, 1], is the polynomial of degree `Degree` through 0, the inner nodes and `end`, at the nodes of
/// Lobatto; `step` is the time of the whole. What is solved for is `between`: the inner nodes, one after another, then
/// the multipliers of the constraints at each inner point.
template <class L, int Degree, CurveQuadrature Points> struct CurveAction {
  using G = typename L::GroupoidType;
  using Rule = CurveRule<Degree, Points>;
  static constexpr int n = L::dimension;
  static constexpr int inner_nodes = Degree - 1;
  static constexpr int each = L::object_constraints;
  static constexpr int kept = each > 0 ? each*(Rule::points - 2) : 0;  ///< constraints at inner points
  static constexpr int inner = n * inner_nodes + kept;
  static_assert(each == 0 || Points == CurveQuadrature::lobatto_pair,
                "the objects of a curve keep their constraints at the points of the pair Lobatto IIIA-IIIB alone");
  template <class S> using Inner = Vector<S, inner>;
  template <class S> using Coordinates = Vector<S, n>;

  const L& lagrangian;
  const G& groupoid;

  static std::string name() {
    if (Points == CurveQuadrature::lobatto_pair) return "Lobatto IIIA-IIIB " + std::to_string(Rule::points);
    return (Points == CurveQuadrature::gauss ? "Gauss " : "Lobatto ") + std::to_string(Rule::points);
  }
  /// Of the step, for curves that are smooth.
  static constexpr int order = Points == CurveQuadrature::lobatto_pair ? 2 * Degree - 2 : 2 * Degree;

  /// Inner nodes on the straight line to `end`, without multipliers.
  template <class S> static Inner<S> straight(const Coordinates<S>& end) {
    Inner<S> between = constants<S>(Vector<double, inner>(Vector<double, inner>::Zero()));
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
    const Allowed<S> allowed = allowed_between(q, end);
    for (std::size_t i = 0; i < std::size_t(Rule::points); ++i)
      sum +=
          density(point<S>(i, q, end, between, step), multipliers(i, between), allowed.at(i)) * Rule::rule().weight[i];
    return sum * step;
  }

  /// The derivative in `between`: zero where the curve is stationary and keeps its constraints.
  template <class S, class Q>
  Inner<S> gradient(const Q& q, const Coordinates<S>& end, const Inner<S>& between, const S& step) const {
    using D = Dual<S>;
    const auto& rule = Rule::rule();
    const auto from = groupoid.template cast_object<D>(q);
    Inner<S> out = constants<S>(Vector<double, inner>(Vector<double, inner>::Zero()));
    const Allowed<S> allowed = allowed_between(q, end);
    for (std::size_t i = 0; i < std::size_t(Rule::points); ++i) {
      const auto both = joined<S, n, n>(combination(rule.value[i], end, between),
                                        Coordinates<S>(combination(rule.derivative[i], end, between) / step));
      const auto lambda = constants<D>(multipliers(i, between));
      const Each<S> there = allowed.at(i);
      const auto offset = constants<D>(there);
      const Vector<S, 2 * n> slope =
          gradient_of([&](const Vector<D, 2 * n>& y) { return density(in_chart(from, y), lambda, offset); }, both);
      for (std::size_t j = 0; j < std::size_t(inner_nodes); ++j)
        for (int k = 0; k < n; ++k)
          out(int(j) * n + k) += slope(k) * step * (rule.weight[i] * rule.value[i][j + 1]) +
                                 slope(n + k) * (rule.weight[i] * rule.derivative[i][j + 1]);
      if constexpr (each > 0)
        if (inside(i)) {
          const Vector<S, each> c = lagrangian.object_constraint(in_chart(q, both).object);
          for (int a = 0; a < each; ++a) out(place(i) + a) = (c(a) - there(a)) * step * rule.weight[i];
        }
    }
    return out;
  }

  /// The same with its derivative, for a Newton iteration.
  detail::EquationsAt<inner> equations(const ObjectOf<G>& q, const Coordinates<double>& end,
                                       const Inner<double>& between, double step) const {
    using J = SecondJet<double, 2 * n>;
    const auto& rule = Rule::rule();
    const auto from = groupoid.template cast_object<J>(q);
    detail::EquationsAt<inner> out;
    Inner<double> terms;
    for (int a = 0; a < inner; ++a) out.value(a) = terms(a) = 0;
    for (int a = 0; a < inner * inner; ++a) out.jacobian(a) = 0;
    const Allowed<double> allowed = allowed_between(q, end);
    for (std::size_t i = 0; i < std::size_t(Rule::points); ++i) {
      const Coordinates<double> x = combination(rule.value[i], end, between);
      const Coordinates<double> rate = combination(rule.derivative[i], end, between) / step;
      Vector<J, 2 * n> y;
      for (int k = 0; k < n; ++k) {
        y(k) = J::variable(x(k), k);
        y(n + k) = J::variable(rate(k), n + k);
      }
      const CurvePoint<G, J> at = in_chart(from, y);
      const Each<double> there = allowed.at(i);
      const J f = density(at, constants<J>(multipliers(i, between)), constants<J>(there));
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
      if constexpr (each > 0)
        if (inside(i)) keep_constraints(i, at.object, there, b, out, terms);
    }
    for (int a = 0; a < inner; ++a) out.measure(a, terms(a));
    return out;
  }

 private:
  template <class S> using Each = Vector<S, each>;
  /// C at both ends, and between them.
  template <class S> struct Allowed {
    Each<S> start;
    Each<S> end;
    Each<S> at(std::size_t i) const {
      const double c = Rule::rule().node[i];
      Each<S> out;
      for (int a = 0; a < each; ++a) out(a) = start(a) * (1 - c) + end(a) * c;
      return out;
    }
  };
  template <class S, class Q> Allowed<S> allowed_between(const Q& q, const Coordinates<S>& end) const {
    Allowed<S> out;
    if constexpr (each > 0) {
      out.start = lagrangian.object_constraint(q);
      out.end = lagrangian.object_constraint(groupoid.target(groupoid.tau(q, end)));
    }
    return out;
  }

  /// Whether point i has multipliers of its own, and the place of the first.
  static bool inside(std::size_t i) { return i > 0 && i + 1 < std::size_t(Rule::points); }
  static int place(std::size_t i) { return n * inner_nodes + each * (int(i) - 1); }
  template <class S> static Each<S> multipliers(std::size_t i, const Inner<S>& between) {
    Each<S> lambda;
    for (int a = 0; a < each; ++a) lambda(a) = inside(i) ? between(place(i) + a) : S(0.0);
    return lambda;
  }

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
  /// The point of AG with chart coordinates and their rates y = (x, x').
  template <class S, class Q> CurvePoint<G, S> in_chart(const Q& q, const Vector<S, 2 * n>& y) const {
    return curve_point<S>(groupoid, q, part<0, n>(y), part<n, n>(y));
  }
  /// l + <lambda, C - allowed>.
  template <class S> S density(const CurvePoint<G, S>& at, const Each<S>& lambda, const Each<S>& allowed) const {
    S out = lagrangian.l(at.object, at.velocity);
    if constexpr (each > 0) {
      const Each<S> c = lagrangian.object_constraint(at.object);
      for (int a = 0; a < each; ++a) out += (c(a) - allowed(a)) * lambda(a);
    }
    return out;
  }
  /// The rows and columns of the multipliers at point i, of weight b.
  template <class Q>
  void keep_constraints(std::size_t i, const Q& q, const Each<double>& allowed, double b,
                        detail::EquationsAt<inner>& out, Inner<double>& terms) const requires(each > 0) {
    const auto c = lagrangian.object_constraint(q);
    double size = 0;  // of the object, whose rounding C has
    for (const auto& coordinate : groupoid.coordinates_of_object(q))
      size = std::max(size, std::abs(double(coordinate.value)));
    for (int a = 0; a < each; ++a) {
      const int column = place(i) + a;
      out.value(column) = b * (c(a).value - allowed(a));
      for (int k = 0; k < n; ++k) {
        const double slope = b * c(a).gradient(k);
        terms(column) += std::abs(slope) * size;
        for (int j = 0; j < inner_nodes; ++j)
          out.jacobian(column, j * n + k) = out.jacobian(j * n + k, column) =
              slope * Rule::rule().value[i][std::size_t(j + 1)];
      }
    }
  }
};

}  // namespace lagroid
