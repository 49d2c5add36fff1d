#pragma once
/// Riemannian nonlinear conjugate gradients (Absil, Mahony and Sepulchre, Optimization Algorithms on Matrix Manifolds,
/// 2008, section 8.3), to compare with.

#include <lagroid/solvers/optimisation/minimise.hpp>

#include <string>

namespace lagroid::optimisation {

/// Directions d+ = -grad f+ + b T d with the b of Hestenes and Stiefel, not below zero, T the transport by projection;
/// the steepest descent where d+ does not descend. Steps by secants (`secant_search`) from the minimum along the line
/// of the parabola whose curvature the last step told.
class ConjugateGradient final : public Method {
 public:
  explicit ConjugateGradient(Retraction retraction = Retraction::qr) : retraction_(retraction) {}

  std::string name() const override { return "conjugate gradients"; }
  void begin(Problem& problem, const State& state) override;
  Step advance(Problem& problem, State& state) override;

 private:
  Retraction retraction_;
  Vector direction_, before_, v_;
  State to_;
  double first_ = 0;
};

}  // namespace lagroid::optimisation
