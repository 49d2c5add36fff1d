#pragma once
/// Riemannian nonlinear conjugate gradients,
///
///     d+ = -grad f(x+) + b T d,    b of Hestenes and Stiefel, T the transport to x+.
///
/// Where value and gradient cost about the same they need fewer evaluations than accelerated descent
/// (docs/optimisation.md).
///
///     using namespace optimisation;
///     ConjugateGradient method;
///     const Result found = minimise(Sphere(3), Height(), Eigen::Vector3d(1, 0, 0), method, {.gradient = 1e-9});
///
/// (`Height` stands in objective.hpp.) Requires a retraction that the manifold offers. (Absil, Mahony and Sepulchre,
/// Optimization Algorithms on Matrix Manifolds, 2008, section 8.3.)

#include <lagroid/solvers/optimisation/minimise.hpp>

#include <optional>
#include <string>

namespace lagroid::optimisation {

/// Directions d+ = -grad f+ + b T d with the b of Hestenes and Stiefel, not below zero, T the manifold's transport;
/// the steepest descent where d+ does not descend. Steps by secants (`secant_search`) from the minimum along the line
/// of the parabola with the curvature of the last step.
class ConjugateGradient final : public DescentMethod {
 public:
  /// Without a retraction by qr or, where that is not offered, along geodesics.
  explicit ConjugateGradient(std::optional<ManifoldRetraction> retraction = {}) : asked_(retraction) {}

  std::string name() const override { return "conjugate gradients"; }
  void begin(Problem& problem, const EvaluatedPoint& state) override;
  StepOutcome advance(Problem& problem, EvaluatedPoint& state) override;

 private:
  std::optional<ManifoldRetraction> asked_;
  ManifoldRetraction retraction_ = ManifoldRetraction::qr;
  Vector direction_, before_, v_;
  EvaluatedPoint to_;
  double first_ = 0;
};

}  // namespace lagroid::optimisation
