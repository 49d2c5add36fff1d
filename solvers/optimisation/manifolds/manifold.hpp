#pragma once
/// Manifolds: what a class must write so that functions can be minimised on it. Most are Q = C^{-1}(0) in a space of
/// matrices E with its metric <A, B> = Trace(A^T B); others have a metric of their own.
///
///     P_x : E -> T_xQ,    R_x : T_xQ -> Q,    R_x(0) = x,  dR_x(0) = 1,    log_x : Q -> T_xQ
///
/// A manifold of your own derives from `Manifold` and is tested by laws::manifold_laws; those here are spheres, Stiefel
/// manifolds, flat spaces, hyperbolic spaces, positive definite matrices and products.
///
///     const optimisation::Sphere sphere(3);
///     optimisation::Point to(3);
///     sphere.retract(optimisation::ManifoldRetraction::qr, Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), to);
///
/// A retraction that is not offered throws std::invalid_argument; what does not exist at a point returns false. [V]
/// 5.3.2, (5.1)

#include <Eigen/Core>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace lagroid::optimisation {

/// Points, tangent vectors and ambient vectors: matrices by columns, those of products one after another.
using Point = Eigen::VectorXd;
using Vector = Eigen::VectorXd;

/// Ways from a tangent vector to a point.
enum class ManifoldRetraction {
  exponential,   ///< along the geodesic
  qr,            ///< Q of the QR decomposition of X + V, R with a positive diagonal
  polar,         ///< the nearest point to X + V
  orthographic,  ///< X + V and a normal vector at X: the step with multipliers of a constrained Hamiltonian map
  cayley         ///< by a skew matrix of rank 2 m
};
std::string_view to_string(ManifoldRetraction retraction);

/// Q = C^{-1}(0) in a space of matrices E. A subclass writes all that is pure here, and `orthographic` with `reach`
/// where there are steps with multipliers; sizes are those of run time. The metric is that of E ([V] 5.3.2) unless
/// `inner` and what follows it say otherwise.
///
/// Invariants (checked by `manifold_laws`): `project` is the derivative of the nearest point, and with the metric of E
/// the orthogonal projection onto the tangent space; `retract` lands on Q, keeps the point for v = 0 and has the
/// derivative of the identity there; `logarithm` inverts the exponential; `orthographic` differs from x + z by a normal
/// vector at x, and is there for every z of reach 1/2; `parallel_transport` keeps inner products.
///
/// Operations use buffers of the manifold: one object for each thread.
class Manifold {
 public:
  virtual ~Manifold() = default;

  virtual std::string name() const = 0;
  /// How many numbers a point has, and how many of them are free.
  virtual Eigen::Index size() const = 0;
  virtual Eigen::Index dimension() const = 0;

  /// The largest |C_i(x)|.
  virtual double residual(const Point& x) const = 0;
  /// |C(x)|^2 / 2, and its gradient dC^T C added to `gradient`, times `weight`: the penalty for leaving Q.
  virtual double penalty(const Point& x, double weight, Vector& gradient) const = 0;
  /// The nearest point of Q. False where there is none or more than one.
  virtual bool nearest(Point& x) const = 0;
  /// v without its normal part at x.
  virtual void project(const Point& x, Vector& v) const = 0;

  /// Whether the metric is not that of E. Then the four functions below are overridden.
  virtual bool has_own_metric() const { return false; }
  /// <u, v> of tangent vectors at x.
  virtual double inner(const Point&, const Vector& u, const Vector& v) const { return u.dot(v); }
  double norm(const Point& x, const Vector& v) const { return std::sqrt(inner(x, v, v)); }
  /// In: D f(x), as a vector of E; out: the Riemannian gradient, <gradient, v> = D f(x) v for all tangent v.
  virtual void gradient(const Point& x, Vector& differential) const { project(x, differential); }
  /// In: a tangent vector at x; out: the differential D f(x) of the functions f(nearest point) of which it is the
  /// gradient.
  virtual void differential(const Point&, Vector&) const {}
  /// v, tangent at `from`, brought to `to`: the vector transport of all methods here. By default its projection.
  virtual void transport(const Point&, const Point& to, Vector& v) const { project(to, v); }
  [[deprecated("transport(from, to, v)")]] void transport(const Point& x, Vector& v) const { project(x, v); }

  virtual bool offers(ManifoldRetraction retraction) const = 0;
  /// From x along the tangent vector v. False outside the retraction's domain. Throws std::invalid_argument for one
  /// that is not offered. `to` may not be `x`.
  virtual bool retract(ManifoldRetraction retraction, const Point& x, const Vector& v, Point& to) const = 0;
  /// The step with multipliers, x+ = x + z - dC^T lambda with C(x+) = 0, for any vector z at x ([V] (3.19)): `to`, and
  /// `moved` = x+ - x without cancellation. False where |tangent part of z| is too long for it. Throws
  /// std::invalid_argument where it is not offered.
  virtual bool orthographic(const Point& x, const Vector& z, Point& to, Vector& moved) const;
  /// A norm of tangent vectors; the step with multipliers exists where it is at most 1/2.
  virtual double reach(const Vector&) const { return std::numeric_limits<double>::infinity(); }
  /// The tangent vector at x whose geodesic reaches y at the time one. False where it is not known in closed form or
  /// not unique.
  virtual bool logarithm(const Point& x, const Point& y, Vector& v) const = 0;
  /// v, tangent at `from`, along the geodesic of `logarithm` to `to`, with lengths and angles unchanged. False where it
  /// is not known in closed form or not unique; v may then be anything.
  virtual bool parallel_transport(const Point&, const Point&, Vector&) const { return false; }
  /// How log_x y changes with y: in, a tangent vector at y; out, what it makes of the logarithm, tangent at x. False
  /// where it is not known in closed form or not unique; v may then be anything.
  virtual bool logarithm_by_end(const Point&, const Point&, Vector&) const { return false; }
  /// How log_x y changes with x: in, a tangent vector at x; out, the covariant derivative along it, which is minus the
  /// Hessian of d(x, y)^2 / 2 times v. False as above.
  virtual bool logarithm_by_start(const Point&, const Point&, Vector&) const { return false; }

  /// The Hessian of the restriction of f to Q along v: in, `h` = D^2 f(x) v of the function on E; out, the tangent
  /// vector P_x h - (Weingarten map of the normal part of `gradient` = D f(x)) v, or what it is in the manifold's own
  /// metric.
  virtual void hessian(const Point& x, const Vector& gradient, const Vector& v, Vector& h) const = 0;

  /// A lower bound of the sectional curvature and an upper bound of the diameter, for (5.1).
  virtual double least_curvature() const = 0;
  virtual double diameter() const = 0;
  /// Whether any two points are joined by one geodesic and curvatures are not positive (a Hadamard manifold): squared
  /// distances are then geodesically convex.
  virtual bool is_hadamard() const { return false; }

  /// Throws std::invalid_argument that names what is offered: for a retraction that is not.
  [[noreturn]] void refuse(ManifoldRetraction retraction) const;
};

/// The retraction that was asked for; without one qr or, where that is not offered, the exponential. Throws
/// std::invalid_argument, with the remedy, for one that is not offered.
ManifoldRetraction chosen_retraction(const Manifold& manifold, std::optional<ManifoldRetraction> asked);

/// zeta of [V] (5.1): sqrt(-K) D coth(sqrt(-K) D) for K < 0, else 1; K bounds the sectional curvature from below, D the
/// diameter of the domain from above.
double zeta(double least_curvature, double diameter);

/// The same with what the manifold knows; `domain` is the diameter of the domain, 0 for that of the manifold. Throws
/// std::invalid_argument, with the remedy, where K < 0 and neither is finite.
double zeta(const Manifold& manifold, double domain);

/// v at x with what is orthogonal to `along` stretched by `factor`: along geodesics of a manifold of constant curvature
/// neighbours draw apart so.
void stretch_across(const Manifold& manifold, const Point& x, const Vector& along, double factor, Vector& v);

}  // namespace lagroid::optimisation
