#pragma once
/// Continuous Hamiltonians, and discrete Lagrangians of type I that are theirs.

#include <lagroid/solvers/generating/hamiltonian_taylor.hpp>

#include "../continuous_lagrangian/subjects.hpp"

#include <algorithm>

namespace lagroid::subjects {

/// p^2 / 2 - cos q.
struct SwingByMomentum : ContinuousHamiltonian<SwingByMomentum, Pair<1>> {
  template <class S> S hamiltonian(const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    using std::cos;
    return p(0) * p(0) * 0.5 - cos(q(0));
  }
};

/// (p^2 + 1) (q^2 + 1) / 2, which is not separable, in two coordinates that are coupled.
struct Coupled : ContinuousHamiltonian<Coupled, Pair<2>> {
  template <class S> S hamiltonian(const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    return (p(0) * p(0) + p(1) * p(1) + 1.0) * (q(0) * q(0) + q(1) * q(1) * 0.5 + 1.0) * 0.5 + q(0) * q(1) * 0.2;
  }
};

/// Of FreeBody.
template <class Group> struct FreeBodyByMomentum : ContinuousHamiltonian<FreeBodyByMomentum<Group>, Group> {
  template <class S> S hamiltonian(const Vector<S, 0>&, const Vector<S, 3>& m) const {
    return (m(0) * m(0) + m(1) * m(1) / 2.0 + m(2) * m(2) / 3.0) * 0.5;
  }
};

/// Of Top.
struct TopByMomentum : ContinuousHamiltonian<TopByMomentum, Top::GroupoidType> {
  template <class S> S hamiltonian(const Vector<S, 3>& v, const Vector<S, 3>& m) const {
    const Top top;
    S sum(0.0);
    for (int i = 0; i < 3; ++i) sum += m(i) * m(i) * (0.5 / top.inertia(i)) + v(i) * top.weight(i);
    return sum;
  }
  template <class Sys> std::vector<Symmetry<Sys>> symmetries_of() const {
    return {{"vertical momentum", [](const Vector<double, 3>& v) { return v; }}};
  }
};

/// Of Bead: on the sphere.
struct BeadByMomentum : ContinuousHamiltonian<BeadByMomentum, Pair<3>, 1> {
  template <class S> S hamiltonian(const Vector<S, 3>& q, const Vector<S, 3>& p) const {
    return (p(0) * p(0) + p(1) * p(1) + p(2) * p(2)) * 0.5 + q(2);
  }
  template <class S> Vector<S, 1> object_constraint(const Vector<S, 3>& q) const { return Bead{}.object_constraint(q); }
};

/// Type I: h l at the source, or at the target, with the velocity tau^{-1}(g) / h.
template <class L, bool AtTarget> struct Rectangle : DiscretisedLagrangian<Rectangle<L, AtTarget>, L> {
  using Common = DiscretisedLagrangian<Rectangle, L>;
  using Common::Common, Common::h;
  static MethodTraits traits() { return {"rectangle", 1, false, true, false}; }
  template <class A> auto lagrangian(const A& g) const {
    using S = ArrowScalar<typename L::GroupoidType, A>;
    Vector<S, L::dimension> xi = this->groupoid.tau_inverse(g);
    for (auto& each : xi) each = each / h;
    return this->l(AtTarget ? this->groupoid.target(g) : this->groupoid.source(g), xi) * h;
  }
};

/// The largest distance of the states along both motions.
template <class A, class B>
double difference(const A& a, const B& b, const State<typename A::GroupoidType>& start, int steps = 20) {
  auto first = make(a, start);
  auto second = make(b, start);
  double worst = 0;
  for (int k = 0; k < steps; ++k) {
    if (!first.advance().converged() || !second.advance().converged()) return INFINITY;
    worst = std::max(worst, (numbers(a, first.point()) - numbers(b, second.point())).norm());
  }
  return worst;
}

/// The same map but for round-off.
inline constexpr double agreement = 1e-12;

/// With r = 0 type II is the rectangle at the source, type III that at the target; they are one map where nothing
/// depends on the object.
template <class L, class H> void expect_rectangles(const State<typename L::GroupoidType>& start, bool one_map) {
  constexpr double h = 0.1;
  const HamiltonianTaylor<H, 0> second{H{}, h};
  const HamiltonianTaylor<H, 0, GeneratingType::three> third{H{}, h};
  EXPECT_LT(difference(second, Rectangle<L, false>{L{}, h}, start), agreement);
  EXPECT_LT(difference(third, Rectangle<L, true>{L{}, h}, start), agreement);
  if (one_map) {
    EXPECT_LT(difference(second, third, start), agreement);
  } else {
    EXPECT_GT(difference(second, third, start), 1e-3) << "two methods are not one map";
  }
}

}  // namespace lagroid::subjects
