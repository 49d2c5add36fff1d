#pragma once
/// Hamiltonians of the examples, and how far a map of them comes.

#include <lagroid/solvers/generating/hamiltonian_map.hpp>
#include <lagroid/solvers/generating/hidden_constraint.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace lagroid::hamiltonian_map_tests {

// ---- systems

/// Unit mass, length and gravity, e3 upwards.
struct Bob {
  static constexpr int dimension = 3;
  static constexpr int constraints = 1;
  template <class S> S hamiltonian(const Vector<S, 3>& q, const Vector<S, 3>& p) const {
    return p.squaredNorm() * 0.5 + q(2);
  }
  template <class S> S lagrangian(const Vector<S, 3>& q, const Vector<S, 3>& v) const {
    return v.squaredNorm() * 0.5 - q(2);
  }
  template <class S> Vector<S, 1> constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>((q.squaredNorm() - 1.0) * 0.5);
  }
};

/// In the plane, with a full mass matrix ((a, b), (b, c)) and a nonlinear potential; on an ellipse or free.
template <int D> struct Plane {
  static constexpr int dimension = 2;
  static constexpr int constraints = D;
  static constexpr double a = 1.5;
  static constexpr double b = 0.4;
  static constexpr double c = 0.8;
  template <class S> S potential(const Vector<S, 2>& q) const {
    using std::cos, std::exp;
    return cos(q(0)) * 0.7 + exp(q(1) * 0.5) * q(0) * 0.3;
  }
  template <class S> S hamiltonian(const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    return (p(0) * p(0) * c - p(0) * p(1) * (2 * b) + p(1) * p(1) * a) * (0.5 / (a * c - b * b)) + potential(q);
  }
  template <class S> S lagrangian(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
    return (v(0) * v(0) * a + v(0) * v(1) * (2 * b) + v(1) * v(1) * c) * 0.5 - potential(q);
  }
  template <class S> Vector<S, D> constraint(const Vector<S, 2>& q) const {
    return Vector<S, D>(q(0) * q(0) * 0.25 + q(1) * q(1) - 1.0);
  }
};

/// One degree of freedom, not separable.
struct Swing {
  static constexpr int dimension = 1;
  static constexpr int constraints = 0;
  template <class S> S hamiltonian(const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    using std::cos, std::sin;
    return p(0) * p(0) / (sin(q(0)) * 0.6 + 2.0) - cos(q(0)) + p(0) * q(0) * 0.1;
  }
};

using Point3 = Phase<3, 1>;

/// Angles from e3, p_theta and p_phi along unit vectors.
inline Point3 bob_at(double theta, double p_theta, double p_phi) {
  const double s = std::sin(theta);
  const double c = std::cos(theta);
  return {{s, 0, c}, {p_theta * c, p_phi, -p_theta * s}};
}

inline const Point3 bob_start = bob_at(1.0, 0.5, 0.7);

template <int D> Phase<2, D> plane_start() {
  Phase<2, D> out{{2 * std::cos(0.6), std::sin(0.6)}, {0.7, -0.2}};
  out.p = project_momentum(Plane<D>{}, out.q, out.p);
  return out;
}

// ---- integrating

/// The state after time T by that many steps; not a number from a step on that failed.
template <class F>
auto end_of(const HamiltonianMap<F>& map, typename HamiltonianMap<F>::Point point, double T, int steps) {
  for (int k = 0; k < steps; ++k)
    if (const auto status = map.step(point, T / steps); status != SolveStatus::converged) {
      ADD_FAILURE() << "step " << k << " of " << steps << ": " << to_string(status);
      point.q.setConstant(std::numeric_limits<double>::quiet_NaN());
      break;
    }
  return point;
}

template <class F> std::function<Point3(Point3)> projected(const F& f, double h) {
  return [map = HamiltonianMap(f), h](Point3 point) {
    EXPECT_EQ(map.step(point, h), SolveStatus::converged);
    point.p = project_momentum(Bob{}, point.q, point.p);
    return point;
  };
}

}  // namespace lagroid::hamiltonian_map_tests
