#pragma once
/// A body with a mass that moves in it, on (shape, attitude), and its mechanical connection: not flat, its group not
/// Abelian.

#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/split_gauge.hpp>

namespace lagroid {

using Bundle = Trivial<2, SO3>;

/// A mass on a plate fixed to a body, held by a spring, on (place on the plate, turn of the body).
struct BodyWithAMass : System<BodyWithAMass, Bundle> {
  double h = 0.05;
  Vector<double, 3> inertia{3, 2, 1};
  double mass = 0.4;
  double height = 0.5;
  double stiffness = 2;

  template <class S> Vector<S, 3> place(const Vector<S, 2>& s) const { return {s(0), s(1), S(height)}; }
  template <class S> S lagrangian(const ArrowOf<Bundle, S>& g) const {
    const auto& [b, turn] = g;
    const Vector<S, 3> w = SO3::log(turn);
    const Vector<S, 3> moved = turn * place(b.target) - place(b.source);
    S twice = moved.squaredNorm() * mass;
    for (int i = 0; i < 3; ++i) twice += w(i) * w(i) * inertia(i);
    return twice * (0.5 / h) - (b.source.squaredNorm() + b.target.squaredNorm()) * (0.25 * h * stiffness);
  }
};

/// The discrete mechanical connection, to second order: while the mass moves, the body turns so that there is no
/// angular momentum, w = -I(r)^{-1} m r x r', I(r) = I + m |r|^2 - m r r^T.
struct WithoutMomentum {
  BodyWithAMass body;
  template <class S> Matrix<S, 3, 3> operator()(const Vector<S, 2>& from, const Vector<S, 2>& to) const {
    const Vector<S, 3> r0 = body.place(from);
    const Vector<S, 3> r1 = body.place(to);
    const Vector<S, 3> r = (r0 + r1) * 0.5;
    const Vector<S, 3> momentum = r0.cross(r1) * body.mass;
    // Sherman and Morrison.
    Vector<S, 3> x;
    Vector<S, 3> y;
    for (int i = 0; i < 3; ++i) {
      const S locked = r.squaredNorm() * body.mass + body.inertia(i);
      x(i) = momentum(i) / locked;
      y(i) = r(i) / locked;
    }
    const S part = r.dot(x) * body.mass / (1.0 - r.dot(y) * body.mass);
    return SO3::exp(Vector<S, 3>(-x - y * part));
  }
};
using Mechanical = TransportConnection<WithoutMomentum, 2, SO3>;

}  // namespace lagroid
