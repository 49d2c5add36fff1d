#pragma once
/// The unit sphere S^(n-1) in R^n, C(x) = (x^T x - 1) / 2: exp_x(v) = x cos|v| + v sin|v| / |v|. n < 2 throws
/// std::invalid_argument.

#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>

namespace lagroid::optimisation {

/// S^(n-1) in R^n, C(x) = (x^T x - 1) / 2. Curvature 1 (n > 2), diameter pi. The orthographic step is
/// x+ = sqrt(1 - |v|^2) x + v, v the tangent part, |v| < 1.
class Sphere final : public Manifold {
 public:
  /// Throws std::invalid_argument for n < 2.
  explicit Sphere(Eigen::Index n);

  std::string name() const override;
  Eigen::Index size() const override { return n_; }
  Eigen::Index dimension() const override { return n_ - 1; }
  double residual(const Point& x) const override;
  double penalty(const Point& x, double weight, Vector& gradient) const override;
  bool nearest(Point& x) const override;
  void project(const Point& x, Vector& v) const override;
  /// exponential; qr, polar and cayley (which coincide: x + v to the length one, but for cayley, the exponential of the
  /// angle 2 atan(|v| / 2)); orthographic.
  bool offers(ManifoldRetraction) const override { return true; }
  bool retract(ManifoldRetraction retraction, const Point& x, const Vector& v, Point& to) const override;
  bool orthographic(const Point& x, const Vector& z, Point& to, Vector& moved) const override;
  double reach(const Vector& v) const override { return v.norm(); }
  bool logarithm(const Point& x, const Point& y, Vector& v) const override;
  /// v - (x + y) <y, v> / (1 + <x, y>). False between opposite points.
  bool parallel_transport(const Point& from, const Point& to, Vector& v) const override;
  /// Brought to x, and across the geodesic times d / sin d.
  bool logarithm_by_end(const Point& x, const Point& y, Vector& v) const override;
  /// -v, and across the geodesic -v d cot d.
  bool logarithm_by_start(const Point& x, const Point& y, Vector& v) const override;
  void hessian(const Point& x, const Vector& gradient, const Vector& v, Vector& h) const override;
  double least_curvature() const override { return n_ > 2 ? 1 : 0; }
  double diameter() const override;

 private:
  Eigen::Index n_;
  mutable Vector moved_, log_;
};

}  // namespace lagroid::optimisation
