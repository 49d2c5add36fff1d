#pragma once
/// A rigid body with a fixed point under gravity, reduced by rotations about the vertical: on the action groupoid of
/// SO(3) on S^2, with v the vertical seen from the body,
///
///     M' = M x I^{-1} M + v x weight,    v' = v x I^{-1} M,    L(g, v) = h l(tau^{-1}(g) / h) - h (U(v) + U(v g)) / 2.
///
///     HeavyTop top;
///     top.inertia = {1, 1, 0.5};
///     const double energy = top.energy({{0, 0.6, 0.8}, {0, 0, 2}});
///
/// Requires positive principal moments and unit vectors v.

#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/core/capabilities/rates_over.hpp>
#include <lagroid/core/capabilities/reductions.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/systems/control/rotation_map.hpp>
#include <lagroid/systems/instances.hpp>
#include <lagroid/systems/rotations/rotation_splitting.hpp>

namespace lagroid {

/// L(g, v) = h l(tau^{-1}(g) / h) - h (U(v) + U(v g)) / 2 with l(w) = w.I w / 2, U(v) = w.v, on the action groupoid of
/// SO(3) on S^2: v = A^T e3 is the upward vertical seen from the body, w = `weight` the body's weight times the vector
/// from the fixed point to its centre of mass. Discretises M' = M x I^{-1} M + v x w, v' = v x I^{-1} M.
/// The momentum mu is the body angular momentum M. The configuration is (A_k, e3), the arrow from e3 to v_k.
struct HeavyTop : System<HeavyTop, Action<SO3, RotatedDirections>> {
  double h = 0.01;
  Vector<double, 3> inertia{1, 1, 0.5};  ///< principal moments, kg m^2
  Vector<double, 3> weight{0, 0, 1};     ///< N m
  RotationMap rotation = RotationMap::exponential;

  static auto parameters() {
    return std::tuple(
        inertia_parameter(&HeavyTop::inertia),
        required(parameter("weight", &HeavyTop::weight, "N m", "weight times the vector to the centre of mass")),
        rotation_parameter(&HeavyTop::rotation));
  }

  template <class S, class T> S lagrangian(const Arrow<S>& g, const T& step) const {
    const Vector<S, 3> verticals = g.point + groupoid.target(g);
    const auto& w = varied<S>(weight);
    return rotational_action(g.element, varied<S>(inertia), step, rotation) -
           (verticals(0) * w(0) + verticals(1) * w(1) + verticals(2) * w(2)) * (0.5 * step);
  }
  template <class S> S lagrangian(const Arrow<S>& g) const { return lagrangian(g, h); }

  /// The energy split into w.v, which kicks, and the kinetic energies of a symmetric body and a rest (SplitSystem,
  /// RotationSplitting).
  static constexpr int parts = 3;
  static constexpr bool nystrom = true;
  /// A body with two equal moments turns by the last flow alone.
  bool two_flows() const { return RotationSplitting(inertia).is_symmetric(); }
  template <int Part, class S, class T>
  FlowOf<GroupoidType, S> flow(const T& t, const Vector<S, 3>& v, const Vector<S, 3>& mu) const {
    if constexpr (Part == 0) {
      const auto& load = varied<S>(weight);
      const Vector<S, 3> w(constant<S>(load(0)), constant<S>(load(1)), constant<S>(load(2)));
      return {{Matrix<S, 3, 3>::Identity(), v}, v.cross(w) * S(t)};
    } else {
      const BasicRotationSplitting<ParameterScalar<S>> kinetic(varied<S>(inertia));
      const FlowOf<SO3, S> turn = Part == 1 ? kinetic.rest(t, mu) : kinetic.symmetric(t, mu);
      return {{turn.arrow, v}, turn.momentum_change};
    }
  }

  /// I^{-1} M, M' = M x I^{-1} M + v x w.
  template <class S = double> RatesOver<GroupoidType, S> rates(const State<GroupoidType, S>& s) const {
    const Vector<S, 3> velocity = s.momentum.cwiseQuotient(varied<S>(inertia));
    return {velocity, s.momentum.cross(velocity) + s.object.cross(varied<S>(weight))};
  }

  /// M.I^{-1} M / 2 + w.v.
  double energy(const State<GroupoidType>& s) const {
    return 0.5 * s.momentum.cwiseQuotient(inertia).dot(s.momentum) + weight.dot(s.object);
  }
  /// Two equal moments of inertia and the centre of mass on the third axis, which is e3.
  bool is_lagrange() const { return inertia(0) == inertia(1) && weight(0) == 0 && weight(1) == 0; }
  /// Two equal moments, the third half as large, and the centre of mass in the plane of the equal ones.
  bool is_kovalevskaya() const { return inertia(0) == inertia(1) && inertia(0) == 2 * inertia(2) && weight(2) == 0; }
  /// Kovalevskaya's integral |w^2 - c v / I3|^2 of the continuous top, with the complex numbers w = w1 + i w2 of the
  /// angular velocity, v = v1 + i v2 and c = weight1 + i weight2.
  double kovalevskaya_integral(const State<GroupoidType>& s) const;

  /// Of sigma = (w0^2 + |w|^2)^(-1/2), w = I^{-1} M, w0^2 = 2 |weight| / tr I: smooth in the moments, and for a
  /// bar w0 is the frequency of small swings.
  template <class S> S time_scale_rate(const Vector<S, 3>& v, const Vector<S, 3>& mu) const {
    using std::sqrt;
    const auto& moments = varied<S>(inertia);
    const auto& arm = varied<S>(weight);
    const Vector<S, 3> w(mu(0) / moments(0), mu(1) / moments(1), mu(2) / moments(2));
    const Vector<S, 3> load(S(arm(0)), S(arm(1)), S(arm(2)));
    const Vector<S, 3> torque = mu.cross(w) + v.cross(load);
    S size = w.squaredNorm();
    if (weight.squaredNorm() > 0) size += 2.0 * sqrt(load.squaredNorm()) / (moments(0) + moments(1) + moments(2));
    if (!(size > S(0.0))) return S(0.0);
    return -(w(0) * torque(0) / moments(0) + w(1) * torque(1) / moments(1) + w(2) * torque(2) / moments(2)) / size;
  }
  double time_scale_rate(const State<GroupoidType>& s) const { return time_scale_rate(s.object, s.momentum); }

  /// The rotation by h I^{-1} M, exact to second order in h.
  Step<HeavyTop> first_guess(const State<GroupoidType>& s) const {
    return {{SO3::exp(Vector<double, 3>(h * s.momentum.cwiseQuotient(inertia))), s.object}, {}};
  }

  /// The continuous solution after time t. Returns (v, M) and updates `attitude`.
  State<GroupoidType> reference(const State<GroupoidType>& start, Matrix<double, 3, 3>& attitude, double t) const;

  /// Turning about the vertical; a Lagrange top also about its own axis.
  std::vector<Symmetry<HeavyTop>> symmetries() const;
  std::vector<Quantity<HeavyTop>> quantities() const;
  static std::vector<ObservedName> observed_names() {
    return {{"H", "energy"},
            {"Jz", "vertical momentum M.v"},
            {"axial", "axial momentum M3"},
            {"K", "Kovalevskaya integral"},
            {"angular_velocity", "w1"},
            {"angular_velocity", "w2"},
            {"angular_velocity", "w3"}};
  }
  template <class S> Vector<S, 7> observed(const State<GroupoidType, S>& s, const Arrow<S>& /*configuration*/) const {
    const auto& [v, mu] = s;
    const auto& moments = varied<S>(inertia);
    const auto& c = varied<S>(weight);
    const Vector<S, 3> w = mu.cwiseQuotient(moments);
    const S real = w(0) * w(0) - w(1) * w(1) - (v(0) * c(0) - v(1) * c(1)) / moments(2);
    const S imaginary = w(0) * w(1) * 2.0 - (v(1) * c(0) + v(0) * c(1)) / moments(2);
    Vector<S, 7> out;
    out << mu.dot(w) * 0.5 + (v(0) * c(0) + v(1) * c(1) + v(2) * c(2)), mu.dot(v), mu(2),
        real * real + imaginary * imaginary, w;
    return out;
  }
  static auto reductions() {
    return std::tuple(
        fixed_momentum("vertical-momentum", ShortestRotation{}, "the vertical seen from the body alone moves"));
  }
};

LAGROID_STEPS(extern template, HeavyTop);
LAGROID_SOLVERS(extern template, HeavyTop);

}  // namespace lagroid
