#pragma once
/// A constraint as a part of the function ([V] 5.5).

#include <lagroid/solvers/optimisation/manifold.hpp>
#include <lagroid/solvers/optimisation/objective.hpp>

#include <string>

namespace lagroid::optimisation {

/// f(x) + weight |C(x)|^2 / 2, to be minimised in flat space: its minima are off the manifold by about 1 / weight.
/// Refers to both.
class Penalised final : public Objective {
 public:
  Penalised(const Manifold& manifold, const Objective& objective, double weight)
      : manifold_(manifold), objective_(objective), weight_(weight) {}

  std::string name() const override { return objective_.name() + ", penalised"; }
  double evaluate(const Point& x, Vector& gradient) const override {
    const double value = objective_.evaluate(x, gradient);
    return value + manifold_.penalty(x, weight_, gradient);
  }

 private:
  const Manifold& manifold_;
  const Objective& objective_;
  double weight_;
};

}  // namespace lagroid::optimisation
