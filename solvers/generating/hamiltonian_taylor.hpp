#pragma once
/// Hamiltonian Taylor variational integrators on any groupoid with a retraction: discrete Lagrangians by generating
/// functions of types II and III of a continuous Hamiltonian H on A*G.
///
/// A retraction makes an arrow of an object and a vector of the fibre there, g = tau(q, x), so that a discrete
/// Lagrangian is near the units a function on AG. Its transform in each fibre is the function of type II, on A*G,
///
///     H_d(q, p) = ext over x of  <p, x> - L(tau(q, x)),     L(g) = ext over p of  <p, tau^{-1}(g)> - H_d(alpha(g), p),
///
/// which on the pair groupoid is H_d+(q0, p1) - p1.q0. Type III looks from the other end, L(g; h) = -L'(g^{-1}; -h), L'
/// of type II.
///
///     struct Body : ContinuousHamiltonian<Body, SO3> {
///       template <class S> S hamiltonian(const Vector<S, 0>&, const Vector<S, 3>& m) const {
///         return (m(0) * m(0) + m(1) * m(1) / 2.0 + m(2) * m(2) / 3.0) * 0.5;
///       }
///     };
///     inline const HamiltonianTaylor<Body, 1> system{Body{}, /*h*/ 0.1};  // of order two, type II
///
/// Requires what has `hamiltonian(q, mu)` over any scalar, regular in mu: a ContinuousHamiltonian. Derivatives are
/// exact up to the second; over scalars with higher ones it does not compile. No allocation.
///
/// Where several momenta are stationary, L takes the one that Newton's method reaches from zero.
///
/// Errors: the Lagrangian is not a number where no momentum is stationary, so that a step ends with `not_finite` and is
/// not taken. Nothing throws.
///
/// Source: [V] 5.4.1, (3.2), (3.4) for R^n; [G] section 4 for discrete Lagrangians on groupoids.

#include <lagroid/core/continuous/continuous_hamiltonian.hpp>
#include <lagroid/core/continuous/curve_point.hpp>
#include <lagroid/core/continuous/discretised_lagrangian.hpp>
#include <lagroid/core/hamiltonian/generating_function.hpp>
#include <lagroid/core/hamiltonian/quadrature_rule.hpp>
#include <lagroid/core/scalars/series.hpp>
#include <lagroid/solvers/methods/method.hpp>

#include <algorithm>
#include <type_traits>

namespace lagroid {

namespace detail {

/// Taylor's method in the coordinates (x, mu) of A*G over alpha^{-1}(q), x in the chart of the retraction there. With
/// it the discrete Lagrangian of type II is the stationary value in p of <P, x - Q> + action.
///
/// What is evaluated over many scalars is out of line: it is long to compile where groupoids have long formulas.
template <class H, int R> struct TaylorInChart {
  using G = typename H::GroupoidType;
  static constexpr int n = H::dimension;
  static constexpr int terms = R + 2;
  template <class S> using Row = Vector<S, n>;
  template <class S> using Place = ObjectOf<G, S>;

  const H& system;
  const G& groupoid;
  const QuadratureRule& rule;

  /// Where the motion from (0, p) is after the time h.
  template <class S> struct Arrival {
    Row<S> place;     ///< Q, by Taylor's method of order r + 1
    Row<S> momentum;  ///< P = T_x^T mu, of order r, T_x the map from x' to the velocity: the momentum in the chart
    S action;         ///< h sum b_i (<mu, H_mu> - H) at the times c_i h, of order r
  };
  template <class S> Arrival<S> arrival(const Place<S>& q, const S& h, const Row<S>& p) const {
    Row<Series<S, terms>> x, mu;
    flow(q, p, x, mu);
    Arrival<S> out;
    const Row<S> there = at(x, h), arriving = at(mu, h);
    for (int i = 0; i < n; ++i) {
      out.place(i) = x(i).at(h);
      out.momentum(i) = inner(arriving, velocity<S>(q, there, unit_vector<S, n>(i)));
    }
    out.action = S(0.0);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const S time = h * rule.nodes[i];
      const Row<S> momentum = at(mu, time);
      const Place<S> object = place<S>(q, at(x, time));
      // Along mu, the derivative of H is <mu, H_mu>.
      const Dual<S> energy =
          hamiltonian<Dual<S>>(groupoid.template cast_object<Dual<S>>(object), moved_along<S, n>(momentum, momentum));
      out.action += (energy.derivative - energy.value) * (h * rule.weights[i]);
    }
    return out;
  }

 private:
  template <class S> [[gnu::noinline]] Place<S> place(const Place<S>& q, const Row<S>& x) const {
    if constexpr (object_dimension_of<G>() == 0) {
      return q;
    } else {
      return groupoid.target(groupoid.tau(q, x));
    }
  }
  template <class S> [[gnu::noinline]] Row<S> velocity(const Place<S>& q, const Row<S>& x, const Row<S>& rate) const {
    return velocity_in_chart<S>(groupoid, q, x, rate);
  }
  template <class S> [[gnu::noinline]] S hamiltonian(const Place<S>& q, const Row<S>& mu) const {
    return system.hamiltonian(q, mu);
  }
  template <class S> static S inner(const Row<S>& a, const Row<S>& b) {
    S sum = a(0) * b(0);
    for (int i = 1; i < n; ++i) sum += a(i) * b(i);
    return sum;
  }
  /// By the terms up to t^r.
  template <class S> static Row<S> at(const Row<Series<S, terms>>& z, const S& time) {
    Row<S> out;
    for (int i = 0; i < n; ++i) out(i) = z(i).at(time, R + 1);
    return out;
  }

  /// The coefficients of x up to t^{r+1} and of mu up to t^r. The path is critical for <mu, T_x v> - H(q(x), mu), so
  /// that with y = T_x^T mu
  ///
  ///     T_x v = H_mu,    x' = v,    y' = d/dx (<mu, T_x v> - H(q(x), mu)).
  ///
  /// Since T_x is the identity at x = 0, mu and v gain a coefficient in each pass as x and y do, and no T_x is
  /// inverted.
  template <class S>
  void flow(const Place<S>& q, const Row<S>& p, Row<Series<S, terms>>& x, Row<Series<S, terms>>& mu) const {
    using T = Series<S, terms>;
    using D = Dual<T>;
    const Place<T> from = groupoid.template cast_object<T>(q);
    const Place<D> start = groupoid.template cast_object<D>(q);
    Row<T> y, v;
    for (int i = 0; i < n; ++i) {
      x(i) = v(i) = T(0.0);
      y(i) = mu(i) = T(p(i));
    }
    for (int k = 1; k < terms; ++k) {
      Row<T> columns[n], chart_momentum;  // of T_x
      for (int i = 0; i < n; ++i) {
        columns[i] = velocity<T>(from, x, unit_vector<T, n>(i));
        chart_momentum(i) = inner(mu, columns[i]);
      }
      for (int i = 0; i < n; ++i) mu(i) += y(i) - chart_momentum(i);
      const Place<D> object = groupoid.template cast_object<D>(place<T>(from, x));
      Row<T> rate = gradient_of([&](const Row<D>& moved) { return hamiltonian<D>(object, moved); }, mu);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) rate(i) -= columns[j](i) * v(j);
      for (int i = 0; i < n; ++i) {
        v(i) += rate(i);
        x(i)[k] = v(i)[k - 1] / double(k);
      }
      if (k + 1 == terms) break;
      const Row<D> along = constants<D>(v), momentum = constants<D>(mu);
      const Row<T> force = gradient_of(
          [&](const Row<D>& moved) {
            return D(inner(momentum, velocity<D>(start, moved, along)) -
                     hamiltonian<D>(place<D>(start, moved), momentum));
          },
          x);
      for (int i = 0; i < n; ++i) y(i)[k] = force(i)[k - 1] / double(k);
    }
  }
};

}  // namespace detail

/// Of order min(r + 1, s), r >= 0 that of Taylor's method and s the quadrature's (one for r = 0); with object
/// constraints no more than two. Type II or III, `Kind`.
template <class H, int R, GeneratingType Kind = GeneratingType::two,
          const QuadratureRule& Rule = quadrature_rules::trapezoid>
struct HamiltonianTaylor : DiscretisedLagrangian<HamiltonianTaylor<H, R, Kind, Rule>, H> {
  static_assert(R >= 0);
  static_assert(Kind != GeneratingType::one, "type I is a function of arrows: Midpoint, Trapezoidal, Galerkin");
  static_assert(HasHamiltonian<H>, "hamiltonian(q, mu) is wanted (see ContinuousHamiltonian)");
  using Common = DiscretisedLagrangian<HamiltonianTaylor, H>;
  using Common::Common, Common::h;
  static constexpr int n = H::dimension;
  template <class A> using ScalarOf = ArrowScalar<typename H::GroupoidType, A>;

  static MethodTraits traits() {
    const int free = R == 0 ? 1 : std::min(R + 1, Rule.order);
    return {Kind == GeneratingType::two ? "type-2" : "type-3", H::object_constraints > 0 ? std::min(free, 2) : free,
            false, true, false};
  }

  template <class A, class T> ScalarOf<A> lagrangian(const A& g, const T& step) const {
    if constexpr (Kind == GeneratingType::two) {
      return of_type_two(g, step);
    } else {
      return -of_type_two(this->groupoid.inverse(g), T(-step));
    }
  }
  template <class A> ScalarOf<A> lagrangian(const A& g) const { return lagrangian(g, h); }

 private:
  static constexpr int objects = H::GroupoidType::object_coordinate_count();

  template <class A, class T> ScalarOf<A> of_type_two(const A& g, const T& step) const {
    using S = ScalarOf<A>;
    static_assert(nilpotency<S> <= 2, "the discrete Lagrangian has two derivatives");
    constexpr int given = std::is_arithmetic_v<T> ? objects : objects + 1;
    const auto q = this->groupoid.coordinates_of_object(this->groupoid.source(g));
    const Vector<S, n> x = this->groupoid.tau_inverse(g);
    Vector<S, given + n> y;
    for (int i = 0; i < objects; ++i) y(i) = q(i);
    if constexpr (given > objects) y(objects) = S(step);
    for (int i = 0; i < n; ++i) y(given + i) = x(i);
    const auto found = stationary<given>(detail::numbers_of(y), number_of(step));
    if constexpr (std::is_arithmetic_v<S>) {
      return found.value;
    } else {
      // By Taylor's formula, in what the variables have beside their numbers.
      for (S& each : y) each = each - number_of(each);
      S sum(found.value);
      for (int i = 0; i < given + n; ++i) {
        S slope(found.gradient(i));
        for (int j = 0; j < given + n; ++j) slope += y(j) * (0.5 * found.hessian(i, j));
        sum += y(i) * slope;
      }
      return sum;
    }
  }

  /// L with its derivatives by what is given, the object and possibly h, and by x, one after another.
  template <int Given> struct Stationary {
    double value;
    Vector<double, Given + n> gradient;
    Matrix<double, Given + n, Given + n> hessian;
  };
  template <int Given>
  [[gnu::noinline]] Stationary<Given> stationary(const Vector<double, Given + n>& y, double step) const {
    using J = SecondJet<double, Given + n>;
    const detail::TaylorInChart<H, R> taylor{this->continuous(), this->groupoid, Rule};
    Vector<J, objects> place;
    for (int i = 0; i < objects; ++i) place(i) = J::variable(y(i), i);
    const auto q = this->groupoid.template object_at<J>(place);
    const J time = Given > objects ? J::variable(step, objects) : J(step);
    const Vector<double, n> x = y.template tail<n>();
    typename detail::TaylorInChart<H, R>::template Arrival<J> arrival;
    J value;
    const auto evaluate = [&](const Vector<double, n>& momentum) {
      Vector<J, n> p;
      for (int i = 0; i < n; ++i) p(i) = J::variable(momentum(i), Given + i);
      arrival = taylor.template arrival<J>(q, time, p);
      value = arrival.action;
      for (int i = 0; i < n; ++i) value += arrival.momentum(i) * (x(i) - arrival.place(i));
      return detail::stationary_in<Given, n>(value, momentum, x);
    };
    const auto root = detail::newton_iteration<n>(evaluate, Vector<double, n>(Vector<double, n>::Zero()));
    evaluate(root.x);
    // In y = (given, x) the second derivative is F_yy - F_yp F_pp^{-1} F_py, and F_x = P.
    Stationary<Given> out;
    Matrix<double, Given + n, n> mixed;
    out.value = value.value;
    out.hessian.setZero();
    for (int i = 0; i < Given; ++i) {
      out.gradient(i) = value.gradient(i);
      for (int j = 0; j < Given; ++j) out.hessian(i, j) = value.hessian(i, j);
      for (int j = 0; j < n; ++j) {
        out.hessian(i, Given + j) = out.hessian(Given + j, i) = arrival.momentum(j).gradient(i);
        mixed(i, j) = value.hessian(i, Given + j);
      }
    }
    for (int i = 0; i < n; ++i) {
      out.gradient(Given + i) = arrival.momentum(i).value;
      for (int j = 0; j < n; ++j) mixed(Given + i, j) = arrival.momentum(i).gradient(Given + j);
    }
    out.hessian -= mixed * root.inverse * mixed.transpose();
    return out;
  }
};

}  // namespace lagroid
