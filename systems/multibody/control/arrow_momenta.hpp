#pragma once
/// The kinetic terms of one factor of a scene along an arrow, as its momenta at both ends,
///
///     F-(x, x', h) = m (x' - x) / h = F+,    or    F- = (dtau^{-1}_{-xi})^T I xi / h, F+ = g^T F-, g = tau(xi) = A^T
///     A',
///
/// over any scalar. A detail of SceneTranscription. Requires turns below a half one. [G] 6.1

#include <lagroid/systems/multibody/rotation_increment.hpp>

namespace lagroid::multibody {

template <class S> struct ArrowMomenta {
  Vector<S, 3> source;  ///< F-
  Vector<S, 3> target;  ///< F+
};

template <class S> ArrowMomenta<S> arrow_momenta(const Vec& inertia, const Vector<S, 3>& displacement, const S& h) {
  Vector<S, 3> p;
  for (int i = 0; i < 3; ++i) p(i) = displacement(i) * inertia(i) / h;
  return {p, p};
}

template <class S> Matrix<S, 3, 3> turn_of(Retraction map, const Vector<S, 3>& xi) {
  return map == Retraction::exponential ? SO3::exp(xi) : SO3::cayley(xi);
}

/// Of the turn g from the source's frame to the target's.
template <class S>
ArrowMomenta<S> arrow_momenta(const Vec& moments, Retraction map, const Matrix<S, 3, 3>& g, const S& h) {
  BasicRotationIncrement<S> increment;
  for (int i = 0; i < 3; ++i) increment.inertia_over_h(i) = moments(i) / h;
  increment.map = map;
  const Vector<S, 3> xi = map == Retraction::exponential ? SO3::log(g) : SO3::cayley_inverse(g);
  ArrowMomenta<S> out;
  out.source = increment.momentum(xi);
  out.target = SO3::inverse(g) * out.source;
  return out;
}

}  // namespace lagroid::multibody
