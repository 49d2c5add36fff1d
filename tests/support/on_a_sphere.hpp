#pragma once
// Motions on a sphere of R^3 with forces or a nonholonomic constraint beside |q|: an object constraint each.
#include <lagroid/core/testing/property.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/reference.hpp>

#include <vector>

namespace lagroid {

/// A spherical pendulum in a viscous fluid: a force beside an object constraint.
struct Viscous : SphericalPendulum {
  double drag = 0.4;

  template <class S, class T> Forces<S, 3> forces(const PairArrow<S, 3>& g, const T& /*step*/) const {
    const Vector<S, 3> half = (g.target - g.source) * (-0.5 * drag);
    return {half, half};
  }
  template <class S> Forces<S, 3> forces(const PairArrow<S, 3>& g) const { return forces(g, h); }
  // Drag takes what the pendulum's symmetries keep.
  std::vector<Quantity<Viscous>> quantities() const { return {}; }
  std::vector<Symmetry<Viscous>> symmetries() const { return {}; }

  State<Pair<3>> reference(const State<Pair<3>>& start, double t) const {
    Eigen::VectorXd y(6);
    y << start.object, start.momentum;
    y = integrate_reference(
        [this](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
          const auto q = at.head<3>();
          const auto p = at.tail<3>();
          const double tension = (bob_mass * gravity * q(2) - p.squaredNorm() / bob_mass) / q.squaredNorm();
          out.head<3>() = p / bob_mass;
          out.tail<3>() = tension * q - drag / bob_mass * p;
          out(5) -= bob_mass * gravity;
        },
        y, t);
    return {y.head<3>(), y.tail<3>()};
  }
};

inline State<Pair<3>> draw_on_the_sphere() {
  const Vector<double, 3> q = Vector<double, 3>(laws::draw_uniform(), laws::draw_uniform(), -2).normalized();
  Vector<double, 3> p(laws::draw_uniform(), laws::draw_uniform(), laws::draw_uniform());
  p -= q * q.dot(p);
  return {q, p};
}

/// A skate that keeps to a sphere of R^3: dz = y dx, beside |q| = 1. Without forces.
struct SkateOnASphere : System<SkateOnASphere, Pair<3>, 1, 1> {
  static constexpr auto principle = Principle::nonholonomic;
  double h = 0.02;
  template <class S> S lagrangian(const PairArrow<S, 3>& g) const {
    return (g.target - g.source).squaredNorm() * (0.5 / h);
  }
  template <class S> Vector<S, 1> constraint(const PairArrow<S, 3>& g) const {
    const Vector<S, 3> step = g.target - g.source;
    return Vector<S, 1>(step(2) - (g.source(1) + g.target(1)) * step(0) * 0.5);
  }
  template <class S> Vector<S, 1> object_constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>(q.squaredNorm() - 1.0);
  }
  Step<SkateOnASphere> first_guess(const State<Pair<3>>& s) const {
    return {{s.object, s.object + h * s.momentum}, {0, 0}};
  }
  std::vector<Quantity<SkateOnASphere>> quantities() const { return {}; }
};

/// A state whose velocity keeps both constraints.
inline State<Pair<3>> draw_skate() {
  const Vector<double, 3> q = Vector<double, 3>(laws::draw_uniform(), laws::draw_uniform(), 1.5).normalized();
  const Vector<double, 3> v = q.cross(Vector<double, 3>(-q(1), 0, 1));
  return {q, (1 + 0.5 * laws::draw_uniform()) * v};
}

}  // namespace lagroid
