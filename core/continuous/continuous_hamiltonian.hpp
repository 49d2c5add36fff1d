#pragma once
/// A continuous Hamiltonian H : A*G -> R on the dual of the Lie algebroid of a groupoid. It is a continuous Lagrangian
/// by the Legendre transform in each fibre,
///
///     l(q, xi) = ext over mu of  <mu, xi> - H(q, mu),
///
/// so that a system that is known by its Hamiltonian is discretised by whatever takes a Lagrangian, and by
/// HamiltonianTaylor (solvers/generating/hamiltonian_taylor.hpp), which takes H itself.
///
///     struct Spring : ContinuousHamiltonian<Spring, Pair<1>> {
///       template <class S> S hamiltonian(const Vector<S, 1>& q, const Vector<S, 1>& p) const {
///         return (p(0) * p(0) + q(0) * q(0)) * 0.5;
///       }
///     };
///     inline const Midpoint<Spring> system{Spring{}, /*h*/ 0.1};  // rules_of_order_two.hpp
///
/// Requires an H over any scalar that is regular in mu. mu is a momentum in A*_qG in the basis that the retraction
/// fixes: p on the pair groupoid, the body momentum on a Lie group. Where several momenta have one velocity, as of an H
/// that is not convex, l is that of the one which Newton's method reaches from zero.
///
/// Errors: l is not a number (NaN) where Newton's method, from zero, finds no momentum of the velocity.

#include <lagroid/core/continuous/continuous_lagrangian.hpp>
#include <lagroid/core/derivatives/implicit.hpp>
#include <lagroid/core/scalars/second_jet.hpp>

namespace lagroid {

namespace detail {

/// That a function is stationary in its variables `First`, ..., First + N - 1, of the numbers x; terms(i) is the size
/// of what cancels in slope i beside second derivatives times x.
template <int First, int N, class J>
EquationsAt<N> stationary_in(const J& value, const Vector<double, N>& x, const Vector<double, N>& terms) {
  EquationsAt<N> out;
  for (int i = 0; i < N; ++i) {
    double size = std::abs(terms(i));
    for (int j = 0; j < N; ++j) {
      out.jacobian(i, j) = value.hessian(First + i, First + j);
      size += std::abs(out.jacobian(i, j) * x(j));
    }
    out.value(i) = value.gradient(First + i);
    out.measure(i, size);
  }
  return out;
}

/// The plain numbers of a vector.
template <class S, int N> Vector<double, N> numbers_of(const Vector<S, N>& x) {
  Vector<double, N> out;
  for (int i = 0; i < N; ++i) out(i) = number_of(x(i));
  return out;
}

/// ext over x of <y, x> - f(q, x).
template <class G, class S, class Q, int N, class F>
S fibre_transform(const G& groupoid, const F& f, const Q& q, const Vector<S, N>& y) {
  const auto paired = [&f](const auto& at, const auto& x, const auto& with) {
    auto sum = -f(at, x);
    for (int i = 0; i < N; ++i) sum += x(i) * with(i);
    return sum;
  };
  using J = SecondJet<double, N>;
  using D = Dual<S>;
  const auto place = groupoid.template object_at<double>(numbers_of(groupoid.coordinates_of_object(q)));
  const auto fixed = groupoid.template cast_object<J>(place);
  const Vector<double, N> numbers = numbers_of(y);
  const auto equations = [&](const Vector<double, N>& x) {
    Vector<J, N> seeded;
    for (int i = 0; i < N; ++i) seeded(i) = J::variable(x(i), i);
    return stationary_in<0, N>(paired(fixed, seeded, numbers), x, numbers);
  };
  const Root<N> root = newton_iteration<N>(equations, Vector<double, N>(Vector<double, N>::Zero()));
  const auto from = groupoid.template cast_object<D>(q);
  const auto with = constants<D>(y);
  // An error e of x is one of e^2 in the value.
  const Vector<S, N> x = with_infinitesimals<S, N>(
      root,
      [&](const Vector<S, N>& near) {
        return gradient_of([&](const Vector<D, N>& moved) { return paired(from, moved, with); }, near);
      },
      nilpotency<S> / 2);
  return paired(q, x, y);
}

}  // namespace detail

/// Base of continuous Hamiltonians, which are continuous Lagrangians by it. The derived class writes
///
///     S hamiltonian(const Object<S>& q, const Velocity<S>& mu) const
///     Vector<S, ObjectConstraints> object_constraint(const Object<S>& q) const              if there are any
template <class Derived, class G, int ObjectConstraints = 0>
struct ContinuousHamiltonian : ContinuousLagrangian<G, 0, ObjectConstraints> {
  template <class Q, class S> S l(const Q& q, const Vector<S, G::dimension>& xi) const {
    return detail::fibre_transform(
        G{}, [this](const auto& at, const auto& mu) { return static_cast<const Derived&>(*this).hamiltonian(at, mu); },
        q, xi);
  }
};

}  // namespace lagroid
