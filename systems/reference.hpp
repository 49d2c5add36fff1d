#pragma once
/// Solutions of the continuous equations, to compare discretisations with: y' = f(y) by an adaptive
/// Runge-Kutta-Fehlberg 7(8) method with tolerance 1e-14 a step.
///
///     const VectorField spring = [](const Eigen::VectorXd& y, Eigen::VectorXd& dy) { dy << y(1), -y(0); };
///     const Eigen::VectorXd end = integrate_reference(spring, Eigen::Vector2d(1, 0), 3.0);  // at t = 3

#include <lagroid/core/system.hpp>
#include <lagroid/groupoids/pair.hpp>

#include <Eigen/Core>

#include <functional>

namespace lagroid {

/// y' = f(y), written as f(y, dy).
using VectorField = std::function<void(const Eigen::VectorXd&, Eigen::VectorXd&)>;

/// y(t) by an adaptive Runge-Kutta-Fehlberg 7(8) method (Boost.odeint) with relative and absolute tolerance 1e-14 a
/// step.
Eigen::VectorXd integrate_reference(const VectorField& field, const Eigen::VectorXd& start, double t);

/// q' = p / m, p' = force(q, q', time), from `start` at the time `begin`, after a time t.
template <int N, class Force>
State<Pair<N>> reference_motion(double mass, const Force& force, const State<Pair<N>>& start, double t,
                                double begin = 0) {
  using V = Vector<double, N>;
  Eigen::VectorXd y(2 * N + 1);
  y << start.object, start.momentum, begin;
  y = integrate_reference(
      [&](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
        const V velocity = at.segment(N, N) / mass;
        out.head(N) = velocity;
        out.segment(N, N) = force(V(at.head(N)), velocity, at(2 * N));
        out(2 * N) = 1;
      },
      y, t);
  return {y.head(N), y.segment(N, N)};
}

/// On a body with velocity w and an attitude, in the body.
using Torque = std::function<Vector<double, 3>(const Vector<double, 3>& w, const Matrix<double, 3, 3>& attitude)>;

/// M' = M x w + torque(w, A), A' = A hat(w), with w = I^{-1} M and the principal moments I, after a time t. Returns M
/// and updates `attitude`.
Vector<double, 3> reference_turn(const Vector<double, 3>& inertia, const Torque& torque,
                                 const Vector<double, 3>& momentum, Matrix<double, 3, 3>& attitude, double t);

}  // namespace lagroid
