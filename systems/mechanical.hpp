#pragma once
/// Point-mass mechanics on R^n, L = m |q'|^2 / 2 - U(q), discretised as
///
///     L(q0, q1) = m |q1 - q0|^2 / (2 h) - h U,    U at the midpoint, or the mean of both ends (Stormer-Verlet).
///
/// A system of this kind is its mass and its potential; step, splitting, rates and energy follow.
///
///     struct Spring : MechanicalSystem<Spring, 1> {
///       static double mass() { return 1; }
///       template <class S> S potential(const Vector<S, 1>& q) const { return q(0) * q(0) * 0.5; }
///     };
///
/// Requires `mass` and `potential`, the latter over any scalar; with object constraints, flows, rates and reference are
/// the derived class' own.

#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/core/capabilities/rates_over.hpp>
#include <lagroid/core/capabilities/split_system.hpp>
#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/parameter.hpp>
#include <lagroid/core/quantity.hpp>
#include <lagroid/core/scalars/varied.hpp>
#include <lagroid/core/system.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/systems/reference.hpp>

#include <cmath>

namespace lagroid {

/// Where the potential is evaluated on an arrow (q0, q1). Both are symmetric, symplectic and of order 2; the trapezoid
/// is the Stormer-Verlet method.
enum class Quadrature { midpoint, trapezoid };
inline constexpr std::array<std::string_view, 2> quadrature_words{"midpoint", "trapezoid"};

/// L(q0, q1) = m |q1 - q0|^2 / (2 h) - h U, with U the potential by the chosen quadrature. Discretises
/// L = m |q'|^2 / 2 - U(q).
///
/// The derived class writes `double mass() const`, or a template on the scalar of a formula that reads it by `varied`
/// (core/scalars/varied.hpp), and `S potential(const Vector<S, N>& q) const`, and may write, for
/// speed, `Vector<S, N> gradient(const Vector<S, N>& q) const`, dU/dq.
template <class Derived, int N, int ObjectConstraints = 0>
struct MechanicalSystem : System<Derived, Pair<N>, 0, ObjectConstraints> {
  using MembersVary = void;
  double h = 0.01;
  Quadrature quadrature = Quadrature::midpoint;

  template <class S, class T> S lagrangian(const PairArrow<S, N>& g, const T& step) const {
    const Vector<S, N> dq = g.target - g.source;
    const S kinetic = dq.squaredNorm() * (0.5 * mass_in<S>() / step);
    if (quadrature == Quadrature::midpoint) {
      return kinetic - self().potential(Vector<S, N>((g.source + g.target) * 0.5)) * step;
    }
    return kinetic - (self().potential(g.source) + self().potential(g.target)) * (0.5 * step);
  }
  template <class S> S lagrangian(const PairArrow<S, N>& g) const { return lagrangian(g, h); }

  /// The continuous solution after time t: m q' = p, p' = -dU/dq (+ constraint force in the derived class).
  State<Pair<N>> reference(const State<Pair<N>>& start, double t) const requires(ObjectConstraints == 0) {
    using V = Vector<double, N>;
    return reference_motion(
        self().mass(), [&](const V& q, const V&, double) { return force(q); }, start, t);
  }

  /// H = U(q) + |p|^2 / (2 m): kick and drift (SplitSystem), whose Strang step is the trapezoid's, Stormer-Verlet.
  static constexpr int parts = 2;
  static constexpr bool nystrom = true;
  template <int Part, class S, class T>
  FlowOf<Pair<N>, S> flow(const T& t, const Vector<S, N>& q, const Vector<S, N>& p) const
      requires(ObjectConstraints == 0) {
    if constexpr (Part == 0) {
      return {{q, q}, force(q) * S(t)};
    } else {
      const Vector<S, N> dq = p * constant<S>(t / mass_in<S>());
      const Vector<S, N> target = q + dq;
      return {{q, target}, Vector<S, N>::Constant(S(0.0)), dq - (target - q)};
    }
  }

  /// q' = p / m, p' = -dU/dq.
  template <class S = double>
  RatesOver<Pair<N>, S> rates(const State<Pair<N>, S>& s) const requires(ObjectConstraints == 0) {
    return {s.momentum / constant<S>(mass_in<S>()), force(s.object)};
  }

  /// H = |p|^2 / (2 m) + U(q).
  double energy(const State<Pair<N>>& s) const { return kinetic_energy(s.momentum) + potential_energy(s.object); }
  /// By velocities, which neither overflow nor underflow where p^2 does.
  template <class S> S kinetic_energy(const Vector<S, N>& p) const {
    return p.dot(Vector<S, N>(p / constant<S>(mass_in<S>()))) * 0.5;
  }
  template <class S> S potential_energy(const Vector<S, N>& q) const { return self().potential(q); }

  static std::vector<ObservedName> observed_names() { return {{"H", "energy"}}; }
  template <class S> Vector<S, 1> observed(const State<Pair<N>, S>& s, const PairArrow<S, N>& /*configuration*/) const {
    return Vector<S, 1>(kinetic_energy(s.momentum) + potential_energy(s.object));
  }

 protected:
  static constexpr auto quadrature_parameter() {
    return choice("quadrature", &MechanicalSystem::quadrature, quadrature_words, "of the potential over a step");
  }

  /// The mass in a formula over S.
  template <class S> auto mass_in() const {
    if constexpr (requires { self().template mass<S>(); }) {
      return self().template mass<S>();
    } else {
      return self().mass();
    }
  }

  /// -dU/dq: of the derived class' `gradient(q)`, if it has one, else by automatic differentiation.
  template <class S> Vector<S, N> force(const Vector<S, N>& q) const {
    if constexpr (requires { self().gradient(q); }) {
      return -self().gradient(q);
    } else {
      return -gradient_of([this](const Vector<Dual<S>, N>& x) { return self().potential(x); }, q);
    }
  }

  Quantity<Derived> energy_quantity() const {
    using Point = TrajectoryPoint<Derived>;
    return {"energy",
            {"H"},
            Promise::bounded,
            false,
            [system = self()](const Point& p, double* out) { *out = system.energy(p.state); },
            [system = self()](const Point& p) {
              return system.kinetic_energy(p.state.momentum) + std::abs(system.potential_energy(p.state.object));
            }};
  }

 private:
  const Derived& self() const { return static_cast<const Derived&>(*this); }
};

}  // namespace lagroid
