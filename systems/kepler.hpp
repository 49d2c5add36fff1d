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
  double time_scale_rate(const State<Pair<2>>& s) const {
    return 1.5 * s.object.dot(s.momentum) / s.object.squaredNorm();
  }

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
  static auto reductions() {
    return std::tuple(reduction("rotations", PolarQuotient{}, "rotations about the centre"),
                      fixed_momentum("angular-momentum", PolarQuotient{}, FactorConnection<Factors<1>, Pair<1>, SO2>{},
                                     "the radius alone moves"));
  }
  std::vector<Quantity<Kepler>> quantities() const { return {energy_quantity(), symmetries()[0].quantity()}; }
};

LAGROID_STEPS(extern template, Kepler);
LAGROID_SOLVERS(extern template, Kepler);

}  // namespace lagroid
