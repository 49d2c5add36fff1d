#pragma once
/// Hyperbolic space H^n, of curvature -1, as a sheet of a hyperboloid in R^(n,1):
///
///     -x_0^2 + x_1^2 + ... + x_n^2 = -1,   x_0 > 0,      exp_x(v) = x cosh|v| + v sinh|v| / |v|.
///
///     const optimisation::HyperbolicSpace plane(2);
///     optimisation::Point x(3), y(3);
///     x << 0, 0.5, 0;
///     plane.nearest(x);  // (sqrt(1.25), 0.5, 0)
///     plane.retract(optimisation::ManifoldRetraction::exponential, x, Eigen::Vector3d(0, 0, 1), y);
///
/// n < 1 throws std::invalid_argument. (J. Ratcliffe, Foundations of Hyperbolic Manifolds, 2006, chapter 3.)

#include <lagroid/solvers/optimisation/manifolds/hadamard.hpp>

namespace lagroid::optimisation {

/// H^n with the metric of Minkowski, <u, v> = -u_0 v_0 + u_1 v_1 + ... + u_n v_n, which is positive on tangent spaces.
/// The space parts (x_1, ..., x_n) are coordinates of all of it; the time part x_0 follows from them, and is taken from
/// them: so `nearest` and `project` do, and functions are continued to E as those of the space part.
///
/// No form cancels, near or far out. With radii sinh R = |(x_1, ..., x_n)| and the angle w between space parts the
/// distance d is a sum of squares,
///
///     sinh^2(d / 2) = sinh^2((R_x - R_y) / 2) + sinh R_x sinh R_y sin^2(w / 2),
///
/// and <u, v> and differentials are taken by their radial part, which is smaller by 1 / x_0^2 than that of the space
/// parts, and the rest. Where a point has the radius R rounding leaves about e^R times 1e-16 of a direction, as the
/// numbers of the point do.
class HyperbolicSpace final : public HadamardManifold {
 public:
  /// Throws std::invalid_argument for n < 1.
  explicit HyperbolicSpace(Eigen::Index n);

  std::string name() const override;
  Eigen::Index size() const override { return n_ + 1; }
  Eigen::Index dimension() const override { return n_; }
  /// C(x) = ((1 + x_1^2 + ... + x_n^2) / x_0^2 - 1) / 2: relative, since rounding grows with x_0^2.
  double residual(const Point& x) const override;
  double penalty(const Point& x, double weight, Vector& gradient) const override;
  /// The point with the same space part.
  bool nearest(Point& x) const override;
  void project(const Point& x, Vector& v) const override;

  double inner(const Point& x, const Vector& u, const Vector& v) const override;
  void gradient(const Point& x, Vector& differential) const override;
  void differential(const Point& x, Vector& gradient) const override;

  /// False where numbers overflow: where distances exceed 700 or so.
  bool logarithm(const Point& x, const Point& y, Vector& v) const override;
  /// v + (x + y) <log_x y, v> tanh(d / 2) / d.
  bool parallel_transport(const Point& from, const Point& to, Vector& v) const override;
  /// Brought to x, and across the geodesic times d / sinh d.
  bool logarithm_by_end(const Point& x, const Point& y, Vector& v) const override;
  /// -v, and across the geodesic -v d coth d.
  bool logarithm_by_start(const Point& x, const Point& y, Vector& v) const override;
  /// P_x J h + (x^T G) v, J = diag(-1, 1, ..., 1).
  void hessian(const Point& x, const Vector& gradient, const Vector& v, Vector& h) const override;
  double least_curvature() const override { return n_ > 1 ? -1 : 0; }

 private:
  bool exponential(const Point& x, const Vector& v, Point& to) const override;

  Eigen::Index n_;
  mutable Vector log_, along_;
};

}  // namespace lagroid::optimisation
