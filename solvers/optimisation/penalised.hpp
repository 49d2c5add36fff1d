#pragma once
/// A constraint as a part of the function,
///
///     min f(x) + weight |C(x)|^2 / 2    in flat space, then the nearest point of the manifold.
///
/// To compare with: what methods on the manifold gain over methods that know no manifold.
///
///     using namespace optimisation;
///     ConjugateGradient method;
///     const Result found = minimise_penalised(Sphere(3), Height(), 1e3, Eigen::Vector3d(1, 0, 0), method,
///                                             {.gradient = 1e-6});
///
/// (`Height` stands in objective.hpp.) Requires a positive weight. Outcome: `off_manifold` where the penalty left more
/// than a tenth of the constraint, else those of `minimise`. [V] 5.5

#include <lagroid/solvers/optimisation/minimise.hpp>

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

/// `minimise` without the constraint but with its penalty, and then the nearest point of the manifold: value and
/// gradient are f's there, `off_manifold` is what the penalty left. The outcome is `off_manifold` where that is more
/// than a tenth. Value, gradient and history until then are those of the penalised function.
Result minimise_penalised(const Manifold& manifold, const Objective& objective, double weight, const Point& start,
                          DescentMethod& method, const Stopping& stopping, const Recording& recording = {});

}  // namespace lagroid::optimisation
