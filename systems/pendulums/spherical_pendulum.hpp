#pragma once
/// The spherical pendulum on R^3 with an object constraint,
///
///     L = m |q'|^2 / 2 - m g q3,    C(q) = (|q|^2 - l^2) / 2 = 0.
///
/// With the trapezoid its step is SHAKE, with the momenta that are reported RATTLE.
///
///     const SphericalPendulum pendulum;
///     const double energy = pendulum.energy({{0, 0, -1}, {0.5, 0, 0}});
///
/// Requires a start with |q| = l.

#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/core/scalars/special_functions.hpp>
#include <lagroid/systems/instances.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <Eigen/Geometry>

#include <numbers>

namespace lagroid {

/// A mass m on a rod of length l, q in R^3 with C(q) = (|q|^2 - l^2) / 2 = 0, U = m g q3 (e3 points up).
/// Momentum p = m q'. With the trapezoid this is SHAKE, with projected momenta RATTLE.
struct SphericalPendulum : MechanicalSystem<SphericalPendulum, 3, /*object constraints*/ 1> {
  double bob_mass = 1;  ///< m, kg
  double length = 1;    ///< l, m
  double gravity = 1;   ///< g, m/s^2

  SphericalPendulum() { quadrature = Quadrature::trapezoid; }

  static auto parameters() {
    return std::tuple(parameter("mass", &SphericalPendulum::bob_mass, "kg", "of the bob", positive),
                      parameter("length", &SphericalPendulum::length, "m", "of the rod", positive),
                      parameter("gravity", &SphericalPendulum::gravity, "m/s^2", "acceleration"),
                      quadrature_parameter());
  }
  std::optional<Refusal> refused() const {
    return refuse_lost_digits({"length", "mass"}, "the inertia m l^2", bob_mass * length * length);
  }

  template <class S = double> ParameterScalar<S> mass() const { return varied<S>(bob_mass); }
  template <class S> S potential(const Vector<S, 3>& q) const {
    return q(2) * (varied<S>(bob_mass) * varied<S>(gravity));
  }
  template <class S> Vector<S, 1> object_constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>((q.squaredNorm() - varied<S>(length) * varied<S>(length)) * 0.5);
  }

  /// The energy split, on T*S^2, into the potential, whose tangent part kicks, and the kinetic energy, whose flow goes
  /// along great circles (SplitSystem):
  ///     q(t) = q cos a + p t / m sin a / a,   p(t) = p cos a - q m a^2 / t sin a / a,   a = |p| t / (m l).
  /// Rounding is kept from the sphere and its tangent planes.
  static constexpr int parts = 2;
  static constexpr bool nystrom = true;
  template <int Part, class S, class T>
  FlowOf<Pair<3>, S> flow(const T& t, const Vector<S, 3>& q, const Vector<S, 3>& p) const {
    const double square = length * length;
    if constexpr (Part == 0) {
      const S along = q(2) * (bob_mass * gravity * t / square);
      Vector<S, 3> kick = q * along;
      kick(2) -= S(bob_mass * gravity * t);
      return {{q, q}, kick};
    } else {
      using std::sqrt;
      const S angle_square = p.squaredNorm() * (t * t / (bob_mass * bob_mass * square));
      const S versine = stumpff<2>(angle_square) * angle_square;
      const S ratio = stumpff<1>(angle_square);
      Vector<S, 3> to = q - q * versine + p * (ratio * (t / bob_mass));
      to *= length / sqrt(to.squaredNorm());
      Vector<S, 3> change = -(p * versine) - q * (ratio * p.squaredNorm() * (t / (bob_mass * square)));
      const S off = (p + change).dot(to) / square;
      change -= to * off;
      return {{q, to}, change};
    }
  }

  /// q' = p / m, p' = -m g e3 + s q with s such that the rod keeps its length.
  template <class S = double> RatesOver<Pair<3>, S> rates(const State<Pair<3>, S>& s) const {
    const ParameterScalar<S> m = varied<S>(bob_mass);
    const ParameterScalar<S> g = varied<S>(gravity);
    const Vector<S, 3> velocity = s.momentum / m;
    const S tension = m * (g * s.object(2) - velocity.squaredNorm()) / s.object.squaredNorm();
    return {velocity, s.object * tension - Vector<S, 3>(S(0.0), S(0.0), S(m * g))};
  }

  /// The continuous solution after time t.
  State<Pair<3>> reference(const State<Pair<3>>& start, double t) const;

  /// Of sigma = (w0^2 + |w|^2)^(-1/2), w = p / (m l) the angular velocity, w0^2 = |g| / l.
  template <class S> S time_scale_rate(const Vector<S, 3>&, const Vector<S, 3>& p) const {
    const ParameterScalar<S> weight = varied<S>(bob_mass) * varied<S>(gravity);
    const ParameterScalar<S> size = weight * varied<S>(bob_mass) * varied<S>(length) * (gravity < 0 ? -1.0 : 1.0);
    return p(2) * weight / (p.squaredNorm() + size);
  }
  double time_scale_rate(const State<Pair<3>>& s) const { return time_scale_rate(s.object, s.momentum); }

  /// Revolutions about the vertical.
  static constexpr int loops = 1;
  static PairArrow<double, 3> loop(const Vector<double, 3>& q, const Vector<double, 3>&,
                                   const Vector<double, 1>& turns) {
    Vector<double, 3> turned = q;
    turned.head<2>() = Eigen::Rotation2Dd(2 * std::numbers::pi * turns(0)) * q.head<2>();
    return {q, turned};
  }

  /// Rotation about the vertical.
  std::vector<Symmetry<SphericalPendulum>> symmetries() const {
    return {
        {"vertical angular momentum", [](const Vector<double, 3>& q) { return Vector<double, 3>(-q(1), q(0), 0); }}};
  }
  static std::vector<ObservedName> observed_names() { return {{"H", "energy"}, {"Lz", "vertical angular momentum"}}; }
  template <class S> Vector<S, 2> observed(const State<Pair<3>, S>& s, const PairArrow<S, 3>& /*configuration*/) const {
    const auto& [q, p] = s;
    return {kinetic_energy(p) + potential_energy(q), q(0) * p(1) - q(1) * p(0)};
  }
  std::vector<Quantity<SphericalPendulum>> quantities() const {
    // Near the vertical the bob moves little: its momentum is rounded relative to the rod all the same.
    return {energy_quantity(), symmetries()[0].quantity([](const TrajectoryPoint<SphericalPendulum>& p) {
              return p.state.object.norm() * p.state.momentum.norm();
            })};
  }
};

LAGROID_STEPS(extern template, SphericalPendulum);
LAGROID_SOLVERS(extern template, SphericalPendulum);

}  // namespace lagroid
