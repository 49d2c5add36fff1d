#pragma once
/// A groupoid and a system of a user's own.

#include <lagroid/core/noether.hpp>
#include <lagroid/core/system.hpp>

#include <string>
#include <vector>

/// Pairs of points in the plane in polar coordinates, (r0, angle0, r1, angle1).
struct PolarPairs : lagroid::LieGroupoid<PolarPairs, 2> {
  template <class S> using Arrow = lagroid::Vector<S, 4>;
  template <class S> using Object = lagroid::Vector<S, 2>;
  template <class S> static Object<S> source(const lagroid::Vector<S, 4>& g) { return {g(0), g(1)}; }
  template <class S> static Object<S> target(const lagroid::Vector<S, 4>& g) { return {g(2), g(3)}; }
  template <class S> static Arrow<S> unit(const lagroid::Vector<S, 2>& q) { return {q(0), q(1), q(0), q(1)}; }
  template <class S> static Arrow<S> inverse(const lagroid::Vector<S, 4>& g) { return {g(2), g(3), g(0), g(1)}; }
  template <class S> static Arrow<S> multiply(const lagroid::Vector<S, 4>& g, const lagroid::Vector<S, 4>& k) {
    return {g(0), g(1), k(2), k(3)};
  }
  template <class S> static Arrow<S> tau(const lagroid::Vector<S, 2>& q, const lagroid::Vector<S, 2>& v) {
    return {q(0), q(1), q(0) + v(0), q(1) + v(1)};
  }
  template <class S> static lagroid::Vector<S, 2> tau_inverse(const lagroid::Vector<S, 4>& g) {
    return {g(2) - g(0), g(3) - g(1)};
  }
  static std::string name() { return "polar pairs"; }
};

/// A unit mass on a spring about the origin: L = h ((r'^2 + r0 r1 angle'^2) / 2 - k (r - 1)^2 / 2), r between both
/// ends.
struct Spring : lagroid::System<Spring, PolarPairs> {
  double h = 0.01;
  double stiffness = 4;

  template <class S> S lagrangian(const lagroid::Vector<S, 4>& g) const {
    const S dr = g(2) - g(0);
    const S turned = g(3) - g(1);
    const S longer = (g(0) + g(2)) * 0.5 - S(1.0);
    return (dr * dr + g(0) * g(2) * turned * turned) * (0.5 / h) - longer * longer * (0.5 * h * stiffness);
  }
  /// Turning about the origin leaves L alone.
  std::vector<lagroid::Symmetry<Spring>> symmetries() const {
    return {{"turning", [](const lagroid::Vector<double, 2>&) { return lagroid::Vector<double, 2>(0, 1); }}};
  }
  std::vector<lagroid::Quantity<Spring>> quantities() const { return {symmetries().front().quantity()}; }
};
