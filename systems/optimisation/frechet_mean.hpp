#pragma once
/// The mean of points on a manifold, where they cannot be added: the point whose squared distances to them are least,
///
///     min f(x) = sum_i w_i d(x, y_i)^2 / 2,    grad f = -sum_i w_i log_x y_i.
///
///     const optimisation::HyperbolicSpace plane(2);
///     const double root = std::sqrt(2.0);
///     const optimisation::FrechetMean f(plane, {Eigen::Vector3d(root, 1, 0), Eigen::Vector3d(root, -1, 0)});
///     optimisation::ConjugateGradient method;
///     const auto found = optimisation::minimise(plane, f, Eigen::Vector3d(root, 0, 1), method, {.gradient = 1e-9});
///
/// Requires a manifold that knows its exponential and logarithm. Points off it and weights that do not fit throw
/// std::invalid_argument. (H. Karcher, Comm. Pure Appl. Math. 30 (1977) 509.)

#include <lagroid/solvers/optimisation/sensitivity/parametric_objective.hpp>

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace lagroid::optimisation {

/// f(x) = sum w_i d(x, y_i)^2 / 2, continued to E as that of the nearest point; not a number where a logarithm is not
/// unique. Where curvatures are not positive and geodesics unique, as on `HyperbolicSpace` and `PositiveDefinite`, f is
/// geodesically convex and the mean is one point; its Hessian there is at least one. Of two points it lies between
/// them, exp_y1(w_2 log_y1 y_2), and of positive definite matrices that commute it is the exponential of the mean
/// logarithm.
class FrechetMean final : public ParametricObjective {
 public:
  /// Weights are made to sum to one; none: equal ones. Refers to the manifold. Throws std::invalid_argument for no
  /// points, points off the manifold, and weights that are not positive or not as many.
  FrechetMean(const Manifold& manifold, std::vector<Point> points, const Eigen::VectorXd& weights = {});

  std::string name() const override { return "Frechet mean"; }
  /// On manifolds with `is_hadamard`.
  bool convex() const override { return manifold_.is_hadamard(); }
  double evaluate(const Point& x, Vector& gradient) const override;
  /// -sum w_i of the covariant derivatives of log_x y_i; where the manifold does not know these (`logarithm_by_start`)
  /// by central differences along the geodesic, whose lengths are the manifold's own.
  void hessian(const Point& x, const Vector& v, Vector& h) const override;
  /// `weights`, as they were given, and `points`: the numbers of each point in a row, which is brought to the nearest
  /// point as one of them changes. The slope by a point is not a number where the manifold does not know
  /// `logarithm_by_end`.
  std::vector<ParameterTable> parameters() const override;
  double parameter(const ParameterEntry& which) const override;
  double by_parameter(const ParameterEntry& which, const Point& x, Vector& gradient) const override;
  std::unique_ptr<ParametricObjective> changed(const ParameterEntry& which, double by) const override;

 private:
  double riemannian(const Point& x, Vector& gradient) const;
  bool closed_hessian(Vector& h) const;
  void difference_hessian(double length, Vector& h) const;

  const Manifold& manifold_;
  std::vector<Point> points_;
  Eigen::VectorXd weights_;
  double total_ = 1;  ///< of the weights as they were given
  mutable Point at_, moved_;
  mutable Vector log_, along_, change_, normal_;
};

}  // namespace lagroid::optimisation
