#pragma once
/// The planar Kepler problem: a unit mass under U = -k / |q|,
///
///     q' = p,    p' = -k q / |q|^3.
///
/// Its orbits are known, and its close encounters hard: the first test of steps that adapt.
///
///     Kepler kepler;
///     kepler.h = 0.05;
///     const double energy = kepler.energy({{1, 0}, {0, 1.2}});

#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/core/capabilities/reductions.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/polar.hpp>
#include <lagroid/systems/instances.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace lagroid {

/// A unit mass in the plane around a fixed centre: U = -k / |q|. Momentum p = q'.
struct Kepler : MechanicalSystem<Kepler, 2> {
  double strength = 1;  ///< k, m^3/s^2

  Kepler() { quadrature = Quadrature::trapezoid; }

  static auto parameters() {
    return std::tuple(parameter("strength", &Kepler::strength, "m^3/s^2", "of the attraction"), quadrature_parameter());
  }

  static double mass() { return 1; }
  static constexpr bool attractive = true;
  template <class S> S potential(const Vector<S, 2>& q) const {
    using std::sqrt;
    return constant<S>(-varied<S>(strength)) / sqrt(q.squaredNorm());
  }

  template <class S> Vector<S, 2> gradient(const Vector<S, 2>& q) const {
    using std::sqrt;
    const S square = q.squaredNorm();
    return q * (constant<S>(varied<S>(strength)) / (square * sqrt(square)));
  }

  /// Of sigma = |q|^(3/2), Kepler's third law.
  template <class S> S time_scale_rate(const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    return q.dot(p) * 1.5 / q.squaredNorm();
  }
  double time_scale_rate(const State<Pair<2>>& s) const { return time_scale_rate(s.object, s.momentum); }

  /// The same at the middle of an arrow (HasTimeScaleOfArrows).
  template <class S> S time_scale(const PairArrow<S, 2>& g) const {
    using std::sqrt;
    const Vector<S, 2> middle = (g.source + g.target) * 0.5;
    const S r = sqrt(middle.squaredNorm());
    return r * sqrt(r);
  }

  /// Revolutions about the centre.
  static constexpr int loops = 1;
  static PairArrow<double, 2> loop(const Vector<double, 2>& q, const Vector<double, 2>&,
                                   const Vector<double, 1>& turns) {
    return {q, Eigen::Rotation2Dd(2 * std::numbers::pi * turns(0)) * q};
  }

  /// Rotation about the centre.
  std::vector<Symmetry<Kepler>> symmetries() const {
    return {{"angular momentum", [](const Vector<double, 2>& q) { return Vector<double, 2>(-q(1), q(0)); }}};
  }
  using ByTheAngle = FactorConnection<Factors<1>, Pair<1>, SO2>;
  static auto reductions() {
    return std::tuple(reduction("rotations", PolarQuotient{}, "rotations about the centre"),
                      fixed_momentum("angular-momentum", PolarQuotient{}, ByTheAngle{}, "the radius alone moves"));
  }
  /// At the angle with r0 r1 sin(theta) = h mu. A potential in the middle depends on that angle too.
  bool has_routhian() const { return quadrature == Quadrature::trapezoid; }
  template <class S, class T>
  S routhian(const ByTheAngle&, const PairArrow<S, 1>& b, const Vector<T, 1>& momentum) const {
    using std::atan2, std::sqrt;
    const S r0 = b.source(0);
    const S r1 = b.target(0);
    const T sine = momentum(0) * h;  // times r0 r1, as the cosine
    const S square = r0 * r1 * (r0 * r1);
    const S cosine = sqrt(square - sine * sine);
    const S radial = (r1 - r0) * (r1 - r0) * 0.5 + S(sine * sine) / (r0 * r1 + cosine);
    return radial * (1 / h) + (1.0 / r0 + 1.0 / r1) * (constant<S>(varied<S>(strength)) * (0.5 * h)) -
           atan2(S(sine), cosine) * momentum(0);
  }
  static std::vector<ObservedName> observed_names() { return {{"H", "energy"}, {"L", "angular momentum"}}; }
  template <class S> Vector<S, 2> observed(const State<Pair<2>, S>& s, const PairArrow<S, 2>& /*configuration*/) const {
    const auto& [q, p] = s;
    return {kinetic_energy(p) + potential_energy(q), q(0) * p(1) - q(1) * p(0)};
  }
  std::vector<Quantity<Kepler>> quantities() const { return {energy_quantity(), symmetries()[0].quantity()}; }
};

LAGROID_STEPS(extern template, Kepler);
LAGROID_SOLVERS(extern template, Kepler);

}  // namespace lagroid
