#pragma once
/// The equations of implicit steps on Poisson manifolds: unknowns u in R^N, a residual and the point x_1 where the step
/// ends.
///
/// By a chart of the symplectic groupoid, with p = h dH + h^3 dS_3 + h^5 dS_5 at the middle,
///
///     u = coordinate(middle(x_0, u), p),    x_1 = beta(x_0, u):
///
/// a Poisson map, since the graph of p is a Lagrangian bisection. By a truncated chart, the same with
/// x_0 = alpha(u, p), u the middle itself.
///
///     const GroupoidFormula<FrozenChart<LotkaVolterra>> formula;
///     const auto at = formula.at(Vector<double, 2>(2, 0.5), 0.1, Vector<double, 2>(0, 0));  // at.residual, at.end
///
/// A formula is solved by FormulaStep (steps.hpp). Returns over the scalar of its arguments; `known` is false
/// where a flow left the domain in which it is known. Nothing throws.
///
/// Source: Cosserat, Laurent-Gengoux, Salnikov, arXiv 2303.15883; Cabrera, Martin de Diego, Vaquero, arXiv 2409.04342.

#include <lagroid/groupoids/poisson/charts.hpp>
#include <lagroid/groupoids/poisson/tree_chart.hpp>
#include <lagroid/solvers/poisson/hamilton_jacobi.hpp>
#include <lagroid/solvers/poisson/kept_structure.hpp>

#include <string>
#include <utility>

namespace lagroid {

/// A formula at a point.
template <class S, int N> struct FormulaAt {
  Vector<S, N> residual;
  Vector<S, N> end;
  bool known = true;
};

/// The step by a chart that is exact, of order 2, 4 or 6; the higher ones in Karasev's chart.
template <class Chart, int Order = 2> struct GroupoidFormula {
  static_assert(Order == 2 || Order == 4 || Order == 6);
  static constexpr int size = Chart::size;
  using X = Vector<double, size>;
  Chart chart;

  explicit GroupoidFormula(Chart of = Chart()) : chart(std::move(of)) {}
  static constexpr KeptStructure kept{};
  static constexpr int order = Order;
  const auto& system() const { return chart.system; }

  /// Right to the order of h^2.
  X guess(const X& x, double h) const {
    const X start = system().gradient(x);
    X middle = x + (0.5 * h) * system().field(x, start);
    if (!system().contains(middle)) middle = x;
    return chart.coordinate(middle, X(h * system().gradient(middle)));
  }
  template <class S> FormulaAt<S, size> at(const Vector<S, size>& x, double h, const Vector<S, size>& u) const {
    const auto arc = chart.from(x, u);
    FormulaAt<S, size> out{{}, arc.end, arc.known && contains(arc.middle)};
    if (!out.known) return out;
    Vector<S, size> p = system().gradient(arc.middle) * S(h);
    if constexpr (Order >= 4) p += third_order_gradient(system(), arc.middle) * S(h * h * h);
    if constexpr (Order >= 6) p += fifth_order_gradient(system(), arc.middle) * S(h * h * h * h * h);
    out.residual = u - chart.coordinate(arc.middle, p);
    return out;
  }
  /// d residual / du, without what S_3 and S_5 give to it.
  Matrix<double, size, size> slope(const X& x, double h, const X& u) const {
    using J = Jet<double, size>;
    Vector<J, size> moved;
    for (int i = 0; i < size; ++i) moved(i) = J::variable(u(i), i);
    const auto middle = chart.from(constants<J>(x), moved).middle;
    X at;
    for (int i = 0; i < size; ++i) at(i) = middle(i).value;
    const auto energy = energy_derivatives(system(), at);
    Vector<J, size> p;
    for (int i = 0; i < size; ++i) {
      p(i) = J(h * energy.gradient(i));
      for (int j = 0; j < size; ++j) p(i) += (middle(j) - at(j)) * (h * energy.hessian(i, j));
    }
    const auto coordinate = chart.coordinate(middle, p);
    Matrix<double, size, size> out;
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < size; ++j) out(i, j) = (i == j ? 1.0 : 0.0) - coordinate(i).gradient(j);
    return out;
  }
  template <class S> bool contains(const Vector<S, size>& x) const {
    X value;
    for (int i = 0; i < size; ++i) value(i) = double(value_of(x(i)));
    return system().contains(value);
  }
};

/// The step by trees of up to K orders: for K = 1 the implicit midpoint rule.
template <class Sys, int K> struct TreeFormula {
  static constexpr int size = Sys::dimension;
  using X = Vector<double, size>;
  TreeChart<Sys, K> chart;

  explicit TreeFormula(Sys of = {}) : chart(std::move(of)) {}
  static constexpr KeptStructure kept{K + 2, K + 2};
  static constexpr int order = 2;
  const Sys& system() const { return chart.system; }

  X guess(const X& x, double h) const {
    const X middle = x + (0.5 * h) * system().velocity(x);
    return system().contains(middle) ? middle : x;
  }
  template <class S> FormulaAt<S, size> at(const Vector<S, size>& x, double h, const Vector<S, size>& u) const {
    X value;
    for (int i = 0; i < size; ++i) value(i) = double(value_of(u(i)));
    FormulaAt<S, size> out;
    out.known = system().contains(value);
    if (!out.known) return out;
    const Vector<S, size> p = system().gradient(u) * S(h);
    out.residual = chart.source(u, p) - x;
    out.end = chart.target(u, p);
    return out;
  }
  Matrix<double, size, size> slope(const X&, double h, const X& u) const {
    using J = Jet<double, size>;
    const auto energy = energy_derivatives(system(), u);
    Vector<J, size> moved;
    Vector<J, size> p;
    for (int i = 0; i < size; ++i) moved(i) = J::variable(u(i), i);
    for (int i = 0; i < size; ++i) {
      p(i) = J(h * energy.gradient(i));
      for (int j = 0; j < size; ++j) p(i) += (moved(j) - u(j)) * (h * energy.hessian(i, j));
    }
    const auto from = chart.source(moved, p);
    Matrix<double, size, size> out;
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < size; ++j) out(i, j) = from(i).gradient(j);
    return out;
  }
};

}  // namespace lagroid
