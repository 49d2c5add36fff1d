#pragma once
/// The kinetic terms of one factor of a scene along an arrow and the drag c on it, as momenta at both ends,
///
///     F-(x, x', h) = m (x' - x) / h + c (x' - x) / 2,    F+ = m (x' - x) / h - c (x' - x) / 2,
///     or    F- = (dtau^{-1}_{-xi})^T I xi / h + c xi / 2, F+ = g^T (F- - c xi / 2) - c xi / 2, g = tau(xi) = A^T A',
///
/// over any scalar: drag is a pair of discrete forces, half of it at either end, as in the steps of Multibody. A detail
/// of SceneTranscription. Requires turns below a half one. [G] 6.1

#include <lagroid/systems/multibody/rotation_increment.hpp>

namespace lagroid::multibody {

template <class S> struct ArrowMomenta {
  Vector<S, 3> source;  ///< F-
  Vector<S, 3> target;  ///< F+

  /// Of a force -c v, half of it at either end.
  void drag(const Mat& c, const Vector<S, 3>& displacement) {
    if (c.isZero(0)) return;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const S half = displacement(j) * (0.5 * c(i, j));
        source(i) += half;
        target(i) -= half;
      }
  }
};

template <class S>
ArrowMomenta<S> arrow_momenta(const Vec& inertia, const Mat& drag, const Vector<S, 3>& displacement, const S& h) {
  Vector<S, 3> p;
  for (int i = 0; i < 3; ++i) p(i) = displacement(i) * inertia(i) / h;
  ArrowMomenta<S> out{p, p};
  out.drag(drag, displacement);
  return out;
}

template <class S> Matrix<S, 3, 3> turn_of(Retraction map, const Vector<S, 3>& xi) {
  return map == Retraction::exponential ? SO3::exp(xi) : SO3::cayley(xi);
}
/// xi, g = tau(xi).
template <class S> Vector<S, 3> coordinates_of(Retraction map, const Matrix<S, 3, 3>& g) {
  return map == Retraction::exponential ? SO3::log(g) : SO3::cayley_inverse(g);
}

/// Of the turn g from the source's frame to the target's.
template <class S>
ArrowMomenta<S> arrow_momenta(const Vec& moments, const Mat& drag, Retraction map, const Matrix<S, 3, 3>& g,
                              const S& h) {
  BasicRotationIncrement<S> increment;
  for (int i = 0; i < 3; ++i) increment.inertia_over_h(i) = moments(i) / h;
  increment.map = map;
  const Vector<S, 3> xi = coordinates_of(map, g);
  ArrowMomenta<S> out;
  out.source = increment.momentum(xi);
  out.target = SO3::inverse(g) * out.source;
  out.drag(drag, xi);
  return out;
}

}  // namespace lagroid::multibody
