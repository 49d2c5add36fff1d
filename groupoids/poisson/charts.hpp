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
#include <lagroid/core/poisson/gauss_collocation.hpp>
#include <lagroid/core/poisson/poisson_system.hpp>
#include <lagroid/core/scalars/special_functions.hpp>
#include <lagroid/groupoids/groups/so3.hpp>

#include <string>
#include <utility>

namespace lagroid {

/// An arrow's middle, where its momentum is a covector, and its target.
template <class S, int N> struct ChartArc {
  Vector<S, N> middle;
  Vector<S, N> end;
  bool known = true;
};

/// Base of charts whose coordinate is the momentum itself.
template <class Sys> struct MomentumChart {
  static constexpr int size = Sys::dimension;
  Sys system;

  explicit MomentumChart(Sys of = {}) : system(std::move(of)) {}
  template <class S> Matrix<S, size, size> bivector(const Vector<S, size>& x) const { return system.bivector(x); }
  template <class S> Vector<S, size> momentum(const Vector<S, size>&, const Vector<S, size>& u) const { return u; }
  template <class S> Vector<S, size> coordinate(const Vector<S, size>&, const Vector<S, size>& p) const { return p; }
};

/// Karasev's chart, to round-off: (x, p) -> (int_0^1 X_t dt, X_1), X' = pi(X) p, X_0 = x. These are exponential
/// coordinates: (x, t p) are the arrows along the flow of the linear function <p, .>.
template <class Sys> struct FrozenChart : MomentumChart<Sys> {
  using Base = MomentumChart<Sys>;
  using Base::Base, Base::size;

  template <class S> ChartArc<S, size> from(const Vector<S, size>& x, const Vector<S, size>& p) const {
    const auto arc = gauss_arc([&](const Vector<S, size>& at) { return this->system.field(at, p); }, x);
    return {arc.mean, arc.end, arc.to_round_off};
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
  Matrix<double, size, size> c;

  explicit LogCanonicalChart(Sys of = {}) : Base(std::move(of)), c(this->system.log_coefficients()) {}

  template <class S> ChartArc<S, size> from(const Vector<S, size>& x, const Vector<S, size>& u) const {
    using std::exp;
    ChartArc<S, size> arc;
    for (int i = 0; i < size; ++i) {
      S sum(0.0);
      for (int j = 0; j < size; ++j)
        if (c(i, j) != 0) sum += u(j) * (0.5 * c(i, j));
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
};

/// Of pi(x) p = s x x p on R^3, the dual of so(3), s = Sys::rotation_sign: Karasev's chart in closed form,
/// beta = exp(-s p) x. Folds at |p| = 2 pi.
template <class Sys> struct RotationChart : MomentumChart<Sys> {
  using Base = MomentumChart<Sys>;
  using Base::Base, Base::size;
  static_assert(size == 3);

  template <class S> ChartArc<S, 3> from(const Vector<S, 3>& x, const Vector<S, 3>& p) const {
    const Vector<S, 3> first = turned(p, x);
    const Vector<S, 3> second = turned(p, first);
    const S square = p(0) * p(0) + p(1) * p(1) + p(2) * p(2);
    const S c1 = stumpff<1>(square);
    const S c2 = stumpff<2>(square);
    const S c3 = stumpff<3>(square);
    ChartArc<S, 3> arc;
    for (int i = 0; i < 3; ++i) {
      arc.middle(i) = x(i) + c2 * first(i) + c3 * second(i);
      arc.end(i) = x(i) + c1 * first(i) + c2 * second(i);
    }
    return arc;
  }
  template <class S> Vector<S, 3> product(const Vector<S, 3>&, const Vector<S, 3>& u, const Vector<S, 3>& v) const {
    const Matrix<S, 3, 3> turn = SO3::exp(Vector<S, 3>(v * S(-sign))) * SO3::exp(Vector<S, 3>(u * S(-sign)));
    return SO3::log(turn) * S(-sign);
  }
  static std::string name() { return "symplectic groupoid of so(3)*"; }

 private:
  static constexpr double sign = Sys::rotation_sign;
  /// -s p x y.
  template <class S> static Vector<S, 3> turned(const Vector<S, 3>& p, const Vector<S, 3>& y) {
    Vector<S, 3> out;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      out(i) = (p(k) * y(j) - p(j) * y(k)) * sign;
    }
    return out;
  }
};

/// The same groupoid by Cayley's transform, a = s / 2: alpha = (I + a p^ + a^2 p p^T) middle, beta the same of -p.
/// Rational, and it never folds: the determinant of d alpha is (1 + |p|^2 / 4)^2.
template <class Sys> struct CayleyChart : MomentumChart<Sys> {
  using Base = MomentumChart<Sys>;
  using Base::Base, Base::size;
  static_assert(size == 3);

  template <class S> ChartArc<S, 3> from(const Vector<S, 3>& x, const Vector<S, 3>& p) const {
    ChartArc<S, 3> arc;
    const S scale = 1.0 / (1.0 + (p(0) * p(0) + p(1) * p(1) + p(2) * p(2)) * (a * a));
    for (int i = 0; i < 3; ++i) arc.middle(i) = (x(i) - cross_entry(p, x, i) * a) * scale;
    const S along = (p(0) * arc.middle(0) + p(1) * arc.middle(1) + p(2) * arc.middle(2)) * (a * a);
    for (int i = 0; i < 3; ++i) arc.end(i) = arc.middle(i) - cross_entry(p, arc.middle, i) * a + p(i) * along;
    return arc;
  }
  template <class S> Vector<S, 3> product(const Vector<S, 3>&, const Vector<S, 3>& u, const Vector<S, 3>& v) const {
    const S scale = 1.0 / (1.0 - (u(0) * v(0) + u(1) * v(1) + u(2) * v(2)) * (a * a));
    Vector<S, 3> out;
    for (int i = 0; i < 3; ++i) out(i) = (u(i) + v(i) - cross_entry(v, u, i) * a) * scale;
    return out;
  }
  static std::string name() { return "symplectic groupoid of so(3)*, by Cayley's transform"; }

 private:
  static constexpr double a = 0.5 * Sys::rotation_sign;
  template <class S> static S cross_entry(const Vector<S, 3>& p, const Vector<S, 3>& y, int i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    return p(j) * y(k) - p(k) * y(j);
  }
};

/// Where the flow of rate <form, .> leads in a unit of time: by a chart that is exponential, its `from`.
template <class Chart, class S, int N>
ChartArc<S, N> linear_flow(const Chart& chart, const Vector<S, N>& x, const S& rate, const Vector<double, N>& form) {
  Vector<S, N> p;
  for (int i = 0; i < N; ++i) p(i) = rate * form(i);
  return chart.from(x, p);
}
/// Of populations along one axis i in closed form: x_i stays and x_j' = c_ji x_i p_i x_j.
template <class Sys, class S, int N>
ChartArc<S, N> linear_flow(const LogCanonicalChart<Sys>& chart, const Vector<S, N>& x, const S& rate,
                           const Vector<double, N>& form) {
  using std::exp;
  int axis = -1;
  int entries = 0;
  for (int i = 0; i < N; ++i)
    if (form(i) != 0) {
      axis = i;
      ++entries;
    }
  if (entries != 1) return linear_flow(FrozenChart<Sys>(chart.system), x, rate, form);
  const S u = x(axis) * rate * form(axis);
  ChartArc<S, N> arc{x, x};
  for (int j = 0; j < N; ++j)
    if (const double c = chart.c(j, axis); c != 0) {
      const S half = exp(u * (0.5 * c));
      arc.middle(j) = x(j) * half;
      arc.end(j) = arc.middle(j) * half;
    }
  return arc;
}

namespace detail {

template <class Sys> auto karasev_chart(const Sys& system) {
  if constexpr (requires { Sys::rotation_sign; }) {
    return RotationChart<Sys>(system);
  } else {
    return FrozenChart<Sys>(system);
  }
}
template <class Sys> auto natural_chart(const Sys& system) {
  if constexpr (requires { system.log_coefficients(); }) {
    return LogCanonicalChart<Sys>(system);
  } else if constexpr (requires { Sys::rotation_sign; }) {
    return CayleyChart<Sys>(system);
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
