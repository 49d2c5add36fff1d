#pragma once
/// Split systems at starts, and how far a splitting of them comes.

#include <lagroid/solvers/integrators/splitting.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace lagroid::splitting_tests {

inline HeavyTop asymmetric_top() {
  HeavyTop top;
  top.inertia << 1.1, 0.8, 0.5;
  top.weight << 0.3, -0.2, 0.9;
  return top;
}

struct Rubbed : Kepler {
  template <int Part, class S> FlowOf<Pair<2>, S> flow(double t, const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    auto out = Kepler::flow<Part, S>(t, q, p);
    if (Part == 1) out.momentum_change = p * S(-1e-3 * t);
    return out;
  }
};

template <class Sys>
SplittingIntegrator<Sys> make(const Sys& system, const State<typename Sys::GroupoidType>& start,
                              const Composition& composition) {
  return SplittingIntegrator<Sys>(system, start, system.groupoid.unit(start.object), composition);
}

/// A problem: where it starts, how far it goes, in how few steps, and how far the end of a run is from the exact one.
template <class Sys> struct Problem {
  Sys system;
  State<typename Sys::GroupoidType> start;
  double horizon;
  int steps;
  std::function<double(const TrajectoryPoint<Sys>&)> error;
};

inline Problem<Pendulum> swing() {
  const Pendulum system;
  const State<Pair<1>> start{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
  const auto exact = system.reference(start, 10);
  return {system, start, 10, 20, [exact](const auto& end) {
            return (end.state.object - exact.object).norm() + (end.state.momentum - exact.momentum).norm();
          }};
}

/// Once around an ellipse of eccentricity 0.3.
inline Problem<Kepler> orbit() {
  const Kepler system;
  const State<Pair<2>> start{{0.7, 0}, {0, std::sqrt(1.3 / 0.7)}};
  return {system, start, 2 * std::numbers::pi, 30, [start](const auto& end) {
            return (end.state.object - start.object).norm() + (end.state.momentum - start.momentum).norm();
          }};
}

inline Problem<RigidBody> body() {
  const RigidBody system;
  State<SO3> start;
  start.momentum << 0.3, 1.5, 0.4;
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto exact = system.reference(start, attitude, 10);
  return {system, start, 10, 10, [exact, attitude](const auto& end) {
            return (end.state.momentum - exact.momentum).norm() + (end.configuration - attitude).norm();
          }};
}

inline const State<HeavyTop::GroupoidType> leaning{Vector<double, 3>(0.48, 0.6, 0.64),
                                                   Vector<double, 3>(0.3, -0.2, 1.5)};

inline Problem<HeavyTop> top() {
  const HeavyTop system = asymmetric_top();
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto exact = system.reference(leaning, attitude, 5);
  return {system, leaning, 5, 20, [exact, attitude](const auto& end) {
            return (end.state.object - exact.object).norm() + (end.state.momentum - exact.momentum).norm() +
                   (end.configuration.element - attitude).norm();
          }};
}

inline Problem<SphericalPendulum> bob() {
  const SphericalPendulum system;
  const State<Pair<3>> start{{0.6, 0, -0.8}, {0.4, 0.7, 0.3}};
  const auto exact = system.reference(start, 5);
  return {system, start, 5, 10, [exact](const auto& end) {
            return (end.state.object - exact.object).norm() + (end.state.momentum - exact.momentum).norm();
          }};
}

inline Problem<HeavyTop> lagrange_top() {
  HeavyTop system;
  system.inertia << 1, 1, 0.4;
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto exact = system.reference(leaning, attitude, 5);
  return {system, leaning, 5, 10, [exact, attitude](const auto& end) {
            return (end.state.object - exact.object).norm() + (end.state.momentum - exact.momentum).norm() +
                   (end.configuration.element - attitude).norm();
          }};
}

/// The triple jump with its steps in another order.
inline constexpr std::array<double, 3> lopsided_coefficients{compositions::triple_jump.coefficients[1],
                                                             compositions::triple_jump.coefficients[0],
                                                             compositions::triple_jump.coefficients[2]};

inline constexpr Composition lopsided{"lopsided", 4, lopsided_coefficients, "none"};

}  // namespace lagroid::splitting_tests
