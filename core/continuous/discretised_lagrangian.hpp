#pragma once
/// What the discrete systems that are made of a continuous Lagrangian have in common: the step h, the parameters of the
/// Lagrangian, and what the Legendre transform mu = dl/dxi gives, energy, first guess and the ledger's quantities.
///
/// A rule derives from it and writes `lagrangian`; all the rest of a system is there.
///
///     template <class L> struct Rectangle : DiscretisedLagrangian<Rectangle<L>, L> {
///       using DiscretisedLagrangian<Rectangle<L>, L>::DiscretisedLagrangian;
///       template <class A> auto lagrangian(const A& g) const {
///         return this->l(this->groupoid.source(g), (this->groupoid.tau_inverse(g) / this->h).eval()) * this->h;
///       }
///     };
///
/// Requires an L that derives from ContinuousLagrangian. `velocity_of` returns numbers that are not numbers (NaN) where
/// mu = dl/dxi has no solution that Newton's method finds from rest, as where l is degenerate; the energy is one then,
/// and the first guess the unit arrow. Nothing throws.

#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/core/continuous/continuous_lagrangian.hpp>
#include <lagroid/core/derivatives/implicit.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/core/quantity.hpp>
#include <lagroid/core/scalars/second_jet.hpp>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace lagroid {

/// The scalar over which an arrow of G is given.
template <class G, class A>
using ArrowScalar = typename decltype(std::declval<const G&>().coordinates_of_arrow(std::declval<const A&>()))::Scalar;

/// A velocity and the multipliers of the arrow constraints there.
template <class L> struct VelocityAndMultipliers {
  Vector<double, L::dimension> velocity;
  Vector<double, L::arrow_constraints> multipliers;
};

/// The inverse of the Legendre transform: xi = dH/dmu, or (xi, lambda) with dl/dxi + <lambda, dpsi/dxi> = mu and
/// psi(q, xi) = 0. Not numbers where Newton's method does not converge from rest. No allocation.
template <Continuous L>
requires HasHamiltonian<L> VelocityAndMultipliers<L> velocity_of(const L& system,
                                                                 const typename L::GroupoidType& groupoid,
                                                                 const State<typename L::GroupoidType>& state) {
  const auto q = groupoid.template cast_object<Dual<double>>(state.object);
  return {gradient_of([&](const Vector<Dual<double>, L::dimension>& mu) { return system.hamiltonian(q, mu); },
                      state.momentum),
          {}};
}
template <Continuous L>
VelocityAndMultipliers<L> velocity_of(const L& lagrangian, const typename L::GroupoidType& groupoid,
                                      const State<typename L::GroupoidType>& state) {
  constexpr int n = L::dimension;
  constexpr int m = L::arrow_constraints;
  using J = SecondJet<double, n>;
  using G = typename L::GroupoidType;
  const ObjectOf<G, J> q = groupoid.template cast_object<J>(state.object);
  const auto at = [&](const Vector<double, n + m>& x) {
    Vector<J, n> xi;
    for (int i = 0; i < n; ++i) xi(i) = J::variable(x(i), i);
    J f = lagrangian.l(q, xi);
    detail::EquationsAt<n + m> out;
    for (int i = 0; i < (n + m) * (n + m); ++i) out.jacobian(i) = 0;
    if constexpr (m > 0) {
      const Vector<J, m> psi = lagrangian.psi(q, xi);
      for (int a = 0; a < m; ++a) {
        f += psi(a) * x(n + a);
        double terms = 0;
        for (int i = 0; i < n; ++i) {
          out.jacobian(n + a, i) = out.jacobian(i, n + a) = psi(a).gradient(i);
          terms += std::abs(psi(a).gradient(i) * x(i));
        }
        out.value(n + a) = psi(a).value;
        out.measure(n + a, terms + std::abs(psi(a).value));
      }
    }
    for (int i = 0; i < n; ++i) {
      double terms = std::abs(state.momentum(i));
      for (int j = 0; j < n; ++j) {
        out.jacobian(i, j) = f.hessian(i, j);
        terms += std::abs(f.hessian(i, j) * x(j));
      }
      out.value(i) = f.gradient(i) - state.momentum(i);
      out.measure(i, terms);
    }
    return out;
  };
  const auto root = detail::newton_iteration<n + m>(at, Vector<double, n + m>(Vector<double, n + m>::Zero()));
  return {root.x.template head<n>(), root.x.template tail<m>()};
}

/// Base of the discretisations of a continuous Lagrangian L on its own groupoid: a System, and an L with its parameters
/// as members. The derived class writes lagrangian(g, step) and, if there are arrow constraints, constraint(g, step),
/// and the two without the step.
template <class Derived, class L>
struct DiscretisedLagrangian : System<Derived, typename L::GroupoidType, L::arrow_constraints, L::object_constraints>,
                               L {
  using Base = System<Derived, typename L::GroupoidType, L::arrow_constraints, L::object_constraints>;
  using MembersVary = void;  // some of them exist for some L alone
  using Continuous = L;
  using GroupoidType = typename L::GroupoidType;
  template <class S> using Arrow = typename Base::template Arrow<S>;
  template <class S> using Object = typename Base::template Object<S>;
  static constexpr int dimension = Base::dimension;
  static constexpr int arrow_constraints = Base::arrow_constraints;
  static constexpr int object_constraints = Base::object_constraints;
  static constexpr int n = dimension;

  double h = 0.01;

  explicit DiscretisedLagrangian(L continuous = {}, double step = 0.01) : L(std::move(continuous)), h(step) {
    require_continuous<L>();
  }

  const L& continuous() const { return *this; }

  /// E = <mu, xi> - l(q, xi) at mu = dl/dxi: the energy of the continuous system. H(q, mu) where it is known.
  double energy(const State<GroupoidType>& s) const {
    if constexpr (HasHamiltonian<L>) return this->hamiltonian(s.object, s.momentum);
    const auto [xi, lambda] = velocity_of(continuous(), this->groupoid, s);
    return s.momentum.dot(xi) - this->l(s.object, xi);
  }

  static std::vector<ObservedName> observed_names() { return {{"E", "energy"}}; }
  /// The energy is the extremal value of <mu, xi> - l(q, xi) - <lambda, psi(q, xi)>: its first derivatives are those of
  /// this expression where xi and lambda stay (envelope theorem).
  template <class S> Vector<S, 1> observed(const State<GroupoidType, S>& s, const Arrow<S>& /*configuration*/) const {
    if constexpr (HasHamiltonian<L>) {
      return Vector<S, 1>(this->hamiltonian(s.object, s.momentum));
    } else {
      State<GroupoidType> plain;
      const auto place = this->groupoid.coordinates_of_object(s.object);
      Vector<double, GroupoidType::object_coordinate_count()> numbers;
      for (int i = 0; i < numbers.size(); ++i) numbers(i) = value_of(place(i));
      plain.object = this->groupoid.template object_at<double>(numbers);
      for (int i = 0; i < n; ++i) plain.momentum(i) = value_of(s.momentum(i));
      const auto [velocity, lambda] = velocity_of(continuous(), this->groupoid, plain);
      const auto xi = with_entries_of<Vector<S, n>>(velocity);
      S energy = s.momentum.dot(xi) - this->l(s.object, xi);
      if constexpr (arrow_constraints > 0) {
        const Vector<S, arrow_constraints> psi = this->psi(s.object, xi);
        for (int i = 0; i < arrow_constraints; ++i) energy -= psi(i) * lambda(i);
      }
      return Vector<S, 1>(energy);
    }
  }

  /// tau(q, h xi), exact to second order in h; the unit arrow where there is no such xi.
  Step<Derived> first_guess(const State<GroupoidType>& s) const {
    const auto [xi, lambda] = velocity_of(continuous(), this->groupoid, s);
    Step<Derived> guess;
    if (!xi.allFinite()) return {this->groupoid.unit(s.object), Derived::Multipliers::Zero()};
    guess.arrow = this->groupoid.tau(s.object, Vector<double, n>(h * xi));
    guess.multipliers.setZero();
    guess.multipliers.template head<arrow_constraints>() = lambda;
    return guess;
  }

  std::vector<Symmetry<Derived>> symmetries() const requires requires(const L& each) {
    each.template symmetries_of<Derived>();
  }
  { return this->template symmetries_of<Derived>(); }

  /// The energy, which is bounded, and the constants of the symmetries.
  std::vector<Quantity<Derived>> quantities() const {
    using Point = TrajectoryPoint<Derived>;
    const Derived& self = static_cast<const Derived&>(*this);
    std::vector<Quantity<Derived>> all{
        {"energy", {"E"}, Promise::bounded, false, [system = self](const Point& p, double* out) {
           *out = system.energy(p.state);
         }}};
    if constexpr (requires { self.symmetries(); })
      for (const auto& symmetry : self.symmetries()) all.push_back(symmetry.quantity());
    return all;
  }
};

}  // namespace lagroid
