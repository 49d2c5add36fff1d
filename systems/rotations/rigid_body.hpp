#pragma once
/// The free rigid body on SO(3), with body angular momentum M:
///
///     M' = M x I^{-1} M,    A' = A hat(I^{-1} M),    L(g) = h l(tau^{-1}(g) / h),  l(w) = w.I w / 2.
///
/// The smallest system on a group. Its motion is known, and its spatial momentum A M is kept exactly.
///
///     RigidBody body;
///     body.inertia = {1, 2, 3};
///     const double energy = body.energy({{}, {0.1, 1, 0.1}});
///
/// Requires positive principal moments. [G] 6.1

#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/core/capabilities/rates_over.hpp>
#include <lagroid/core/quantity.hpp>
#include <lagroid/systems/control/rotation_map.hpp>
#include <lagroid/systems/instances.hpp>
#include <lagroid/systems/rotations/rotation_splitting.hpp>

namespace lagroid {

/// Free motion about a fixed point with principal moments of inertia I: L(g) = h l(tau^{-1}(g) / h), l(w) = w.I w / 2,
/// on SO(3) ([G] 6.1). The momentum mu is the body angular momentum M; A_k = A_{k-1} g_k carries body to space.
struct RigidBody : System<RigidBody, SO3> {
  double h = 0.01;
  Vector<double, 3> inertia{1, 2, 3};  ///< principal moments, kg m^2
  RotationMap rotation = RotationMap::exponential;

  static auto parameters() {
    return std::tuple(inertia_parameter(&RigidBody::inertia), rotation_parameter(&RigidBody::rotation));
  }

  template <class S, class T> S lagrangian(const Matrix<S, 3, 3>& g, const T& step) const {
    return rotational_action(g, varied<S>(inertia), step, rotation);
  }
  template <class S> S lagrangian(const Matrix<S, 3, 3>& g) const { return lagrangian(g, h); }

  /// w.I w / 2.
  template <class S> S l(const Vector<S, 3>& w) const {
    return (w(0) * w(0) * inertia(0) + w(1) * w(1) * inertia(1) + w(2) * w(2) * inertia(2)) * 0.5;
  }

  /// The energy split into that of a symmetric top and a rest (SplitSystem, RotationSplitting).
  static constexpr int parts = 2;
  template <int Part, class S, class T>
  FlowOf<SO3, S> flow(const T& t, const Vector<S, 0>&, const Vector<S, 3>& mu) const {
    const BasicRotationSplitting<ParameterScalar<S>> kinetic(varied<S>(inertia));
    if constexpr (Part == 0) return kinetic.rest(t, mu);
    if constexpr (Part == 1) return kinetic.symmetric(t, mu);
  }

  /// M.I^{-1} M / 2.
  double energy(const State<SO3>& s) const { return 0.5 * s.momentum.cwiseQuotient(inertia).dot(s.momentum); }

  /// w = I^{-1} M, M' = M x w.
  template <class S = double> RatesOver<SO3, S> rates(const State<SO3, S>& s) const {
    const Vector<S, 3> w = s.momentum.cwiseQuotient(varied<S>(inertia));
    return {w, s.momentum.cross(w)};
  }

  /// The continuous solution after time t: M' = M x I^{-1} M, A' = A hat(I^{-1} M). Returns M and updates `attitude`.
  State<SO3> reference(const State<SO3>& start, Matrix<double, 3, 3>& attitude, double t) const;

  /// Of sigma = 1 / |w|, w = I^{-1} M.
  template <class S> S time_scale_rate(const Vector<S, 0>&, const Vector<S, 3>& mu) const {
    const auto& moments = varied<S>(inertia);
    const Vector<S, 3> w(mu(0) / moments(0), mu(1) / moments(1), mu(2) / moments(2));
    const Vector<S, 3> torque = mu.cross(w);
    const S size = w.squaredNorm();
    if (!(size > S(0.0))) return S(0.0);
    return -(w(0) * torque(0) / moments(0) + w(1) * torque(1) / moments(1) + w(2) * torque(2) / moments(2)) / size;
  }
  double time_scale_rate(const State<SO3>& s) const { return time_scale_rate(s.object, s.momentum); }

  /// The rotation by h I^{-1} M, exact to second order in h.
  Step<RigidBody> first_guess(const State<SO3>& s) const {
    return {SO3::exp(Vector<double, 3>(h * s.momentum.cwiseQuotient(inertia))), {}};
  }

  static std::vector<ObservedName> observed_names() {
    return {{"H", "energy"},
            {"spatial momentum A M", "Jx"},
            {"spatial momentum A M", "Jy"},
            {"spatial momentum A M", "Jz"},
            {"angular_velocity", "w1"},
            {"angular_velocity", "w2"},
            {"angular_velocity", "w3"}};
  }
  template <class S> Vector<S, 7> observed(const State<SO3, S>& s, const Matrix<S, 3, 3>& attitude) const {
    const Vector<S, 3> w = s.momentum.cwiseQuotient(varied<S>(inertia));
    Vector<S, 7> out;
    out << s.momentum.dot(w) * 0.5, Vector<S, 3>(attitude * s.momentum), w;
    return out;
  }
  std::vector<Quantity<RigidBody>> quantities() const {
    return {{"energy",
             {"H"},
             Promise::bounded,
             false,
             [system = *this](const TrajectoryPoint<RigidBody>& p, double* out) { *out = system.energy(p.state); }},
            {"spatial momentum A M",
             {"Jx", "Jy", "Jz"},
             Promise::conserved,
             false,
             [](const TrajectoryPoint<RigidBody>& p, double* out) {
               Eigen::Map<Vector<double, 3>>(out).noalias() = p.configuration * p.state.momentum;
             }}};
  }
};

LAGROID_STEPS(extern template, RigidBody);
LAGROID_SOLVERS(extern template, RigidBody);

}  // namespace lagroid
