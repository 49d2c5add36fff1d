#pragma once
/// Charts of the local symplectic groupoid of a Poisson manifold: arrows as pairs (x, u) of their source and a
/// coordinate of the source fibre, with the point `middle` and the momentum p that are canonical together,
///
///     {x^i, p_j} = delta^i_j:  {alpha, alpha} = pi(alpha),  {beta, beta} = -pi(beta),  {alpha, beta} = 0,
///
/// alpha = source, beta = target as functions of (middle, p).
///
/// FrozenChart is Karasev's, for every bracket: alpha and beta are the ends of X' = pi(X) p with p frozen, the middle
/// is the mean of X. Where a bracket has a groupoid in closed form, a chart of its own is faster, and may reach
/// further.
///
///     const FrozenChart<LotkaVolterra> chart{LotkaVolterra{}};
///     const auto arc = chart.from(Vector<double, 2>(2, 0.5), Vector<double, 2>(0.1, -0.2));  // arc.middle, arc.end
///
/// A chart of one's own has `from`, `momentum` and its inverse `coordinate`, and `product`, the coordinate of (x, u)
/// (beta(x, u), v); u = 0 at units, and the inverse of (x, u) is (beta(x, u), -u). Returns arcs over the scalar of the
/// arguments; `known` is false where the flow is not known to round-off. Nothing throws.
///
/// Source: Karasev, Analogues of objects of Lie group theory for nonlinear Poisson brackets, 1987; Cosserat,
/// Laurent-Gengoux, Salnikov, Numerical methods in Poisson geometry and their application to mechanics,
/// arXiv 2303.15883; Cabrera, Martin de Diego, Vaquero, arXiv 2409.04342.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/matrices/small_elimination.hpp>
#include <lagroid/core/poisson/linear_arc.hpp>
#include <lagroid/core/poisson/poisson_system.hpp>
#include <lagroid/groupoids/poisson/rotation_charts.hpp>

#include <string>
#include <utility>

namespace lagroid {

/// X' = pi(X) p over a unit of time, and its mean.
template <class Sys, class S, int N>
ChartArc<S, N> frozen_arc(const Sys& system, const Vector<S, N>& x, const Vector<S, N>& p) {
  const auto field = [&](const Vector<S, N>& at) { return system.field(at, p); };
  FlowArc<S, N> arc;
  if constexpr (HasLinearBracket<Sys>) {
    arc = linear_arc(field, x);
  } else {
    arc = gauss_arc(field, x);
  }
  return {arc.mean, arc.end, arc.to_round_off};
}

/// Karasev's chart, to round-off: (x, p) -> (int_0^1 X_t dt, X_1), X' = pi(X) p, X_0 = x. These are exponential
/// coordinates: (x, t p) are the arrows along the flow of the linear function <p, .>.
template <class Sys> struct FrozenChart : MomentumChart<Sys> {
  using Base = MomentumChart<Sys>;
  using Base::Base, Base::size;

  template <class S> ChartArc<S, size> from(const Vector<S, size>& x, const Vector<S, size>& p) const {
    return frozen_arc(this->system, x, p);
  }
  /// (x, u) (beta, v) is where the flow of the Hamiltonian <v, beta> leads in a unit of time from (x, u); it leaves the
  /// source alone: u' = (dM/dx)^{-T} (dX_1/dx)^T v.
  template <class S>
  Vector<S, size> product(const Vector<S, size>& x, const Vector<S, size>& u, const Vector<S, size>& v) const {
    const auto rate = [&](const Vector<S, size>& w) {
      Matrix<S, size, size> middle_by_x;
      Vector<S, size> out;
      for (int k = 0; k < size; ++k) {
        const auto arc = from(moved_along(x, unit_vector<S, size>(k)), constants<Dual<S>>(w));
        out(k) = S(0.0);
        for (int i = 0; i < size; ++i) {
          middle_by_x(k, i) = arc.middle(i).derivative;
          out(k) += arc.end(i).derivative * v(i);
        }
      }
      eliminate(middle_by_x, out);
      return out;
    };
    return gauss_arc(rate, u).end;
  }
  static std::string name() { return "symplectic groupoid of a Poisson manifold"; }
};

/// Of {x_i, x_j} = c_ij x_i x_j, by u_i = x_i p_i at the middle: beta_i = x_i exp(c_ij u_j), and u adds up. An action
/// groupoid of R^N on x > 0. Its arrows are not Karasev's: the middle is the geometric mean.
template <class Sys> struct LogCanonicalChart : MomentumChart<Sys> {
  using Base = MomentumChart<Sys>;
  using Base::size;

  explicit LogCanonicalChart(Sys of = {}) : Base(std::move(of)), numbers_(log_coefficients_of<double>(this->system)) {}

  /// c_ij, with its derivatives by parameters where a formula over S has such.
  template <class S> decltype(auto) coefficients() const {
    if constexpr (std::is_same_v<ParameterScalar<S>, double>) {
      return (numbers_);
    } else {
      return log_coefficients_of<S>(this->system);
    }
  }
  /// Whether a coefficient does anything: one that is zero may have derivatives.
  template <class S, class C> static bool matters(const C& c) {
    return !std::is_same_v<ParameterScalar<S>, double> || value_of(c) != 0;
  }
  template <class S> ChartArc<S, size> from(const Vector<S, size>& x, const Vector<S, size>& u) const {
    using std::exp;
    const auto& c = coefficients<S>();
    ChartArc<S, size> arc;
    for (int i = 0; i < size; ++i) {
      S sum(0.0);
      for (int j = 0; j < size; ++j)
        if (matters<S>(c(i, j))) sum += u(j) * (c(i, j) * 0.5);
      const S half = exp(sum);
      arc.middle(i) = x(i) * half;
      arc.end(i) = arc.middle(i) * half;
    }
    return arc;
  }
  template <class S> Vector<S, size> momentum(const Vector<S, size>& middle, const Vector<S, size>& u) const {
    Vector<S, size> p;
    for (int i = 0; i < size; ++i) p(i) = u(i) / middle(i);
    return p;
  }
  template <class S> Vector<S, size> coordinate(const Vector<S, size>& middle, const Vector<S, size>& p) const {
    Vector<S, size> u;
    for (int i = 0; i < size; ++i) u(i) = middle(i) * p(i);
    return u;
  }
  template <class S>
  Vector<S, size> product(const Vector<S, size>&, const Vector<S, size>& u, const Vector<S, size>& v) const {
    return u + v;
  }
  static std::string name() { return "symplectic groupoid of a log-canonical bracket"; }

 private:
  Matrix<double, size, size> numbers_;
};

namespace detail {

/// x to the end of the arc of the momentum rate * form.
template <class S, int N, class Arc>
bool move_along(Vector<S, N>& x, const S& rate, const Vector<double, N>& form, const Arc& arc_of) {
  Vector<S, N> p;
  for (int j = 0; j < N; ++j) p(j) = rate * form(j);
  const auto arc = arc_of(p);
  x = arc.end;
  return arc.known;
}

}  // namespace detail

/// Takes x to where the flow of rate H_i leads in a unit of time, H_i = <l_i, .> the i-th form of a system; false where
/// that is not known to round-off. By a chart that is exponential.
template <class Chart, class S, int N> bool flow_of_form(const Chart& chart, int i, const S& rate, Vector<S, N>& x) {
  return detail::move_along(x, rate, chart.system.form(i), [&](const auto& p) { return chart.from(x, p); });
}
/// Of populations along the axis i in closed form: x_i stays and x_j' = c_ji x_i x_j.
template <class Sys, class S, int N>
bool flow_of_form(const LogCanonicalChart<Sys>& chart, int i, const S& rate, Vector<S, N>& x) {
  using std::exp;
  using Chart = LogCanonicalChart<Sys>;
  if constexpr (!HasAxesAsForms<Sys>)
    return detail::move_along(x, rate, chart.system.form(i),
                              [&](const auto& p) { return frozen_arc(chart.system, x, p); });
  const auto& c = chart.template coefficients<S>();
  const S u = x(i) * rate;
  for (int j = 0; j < N; ++j)
    if (Chart::template matters<S>(c(j, i))) x(j) = x(j) * exp(u * c(j, i));
  return true;
}

namespace detail {

template <class Sys> auto karasev_chart(const Sys& system) {
  if constexpr (requires { Sys::rotation_sign; }) {
    return RotationChart<Sys>(system);
  } else if constexpr (requires { Sys::turned_vectors; }) {
    return SemidirectChart<Sys, RotationArcs>(system);
  } else {
    return FrozenChart<Sys>(system);
  }
}
template <class Sys> auto natural_chart(const Sys& system) {
  if constexpr (requires { system.log_coefficients(); }) {
    return LogCanonicalChart<Sys>(system);
  } else if constexpr (requires { Sys::rotation_sign; }) {
    return CayleyChart<Sys>(system);
  } else if constexpr (requires { Sys::turned_vectors; }) {
    return SemidirectChart<Sys, CayleyArcs>(system);
  } else {
    return FrozenChart<Sys>(system);
  }
}
template <class Sys> auto flow_chart(const Sys& system) {
  if constexpr (requires { system.log_coefficients(); }) {
    return LogCanonicalChart<Sys>(system);
  } else {
    return karasev_chart(system);
  }
}

}  // namespace detail

/// Karasev's chart of a system, in closed form where it has one; the chart whose steps cost least; and that whose flows
/// of linear functions do.
template <class Sys> using KarasevChart = decltype(detail::karasev_chart(std::declval<const Sys&>()));
template <class Sys> using NaturalChart = decltype(detail::natural_chart(std::declval<const Sys&>()));
template <class Sys> using FlowChart = decltype(detail::flow_chart(std::declval<const Sys&>()));

}  // namespace lagroid
