#pragma once
/// Hadamard manifolds with a metric of their own: complete, without holes and without positive curvature, so that any
/// two points are joined by one geodesic, and steps are taken along it.
///
///     inline bool takes(const optimisation::HadamardManifold& manifold) {
///       return manifold.offers(optimisation::ManifoldRetraction::exponential);
///     }
///
/// HyperbolicSpace and PositiveDefinite derive from it; one of your own writes its metric, exponential, logarithm and
/// parallel transport.

#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>

#include <limits>

namespace lagroid::optimisation {

/// The exponential, of every vector at every point, is the one retraction, and transport is the parallel one.
class HadamardManifold : public Manifold {
 public:
  bool has_own_metric() const final { return true; }
  bool is_hadamard() const final { return true; }
  double diameter() const final { return std::numeric_limits<double>::infinity(); }
  bool offers(ManifoldRetraction retraction) const final { return retraction == ManifoldRetraction::exponential; }
  bool retract(ManifoldRetraction retraction, const Point& x, const Vector& v, Point& to) const final {
    if (!offers(retraction)) refuse(retraction);
    return exponential(x, v, to);
  }
  void transport(const Point& from, const Point& to, Vector& v) const final { parallel_transport(from, to, v); }

 protected:
  /// Where the geodesic that leaves x along the tangent vector v is at the time one. False where numbers overflow.
  virtual bool exponential(const Point& x, const Vector& v, Point& to) const = 0;
};

}  // namespace lagroid::optimisation
