#pragma once
/// Riemannian gradient descent, X+ = R_X(-t grad f(X)), with a fixed t, t = c / L or a line search: the simplest
/// method, to compare with.
///
///     using namespace optimisation;
///     GradientDescent method({.c = 1});
///     const Result found = minimise(Sphere(3), Height(), Eigen::Vector3d(1, 0, 0), method, {.gradient = 1e-9});
///
/// (`Height` stands in objective.hpp.) Options out of range throw std::invalid_argument, with the remedy. [V] Algorithm
/// 3

#include <lagroid/solvers/optimisation/minimise.hpp>

#include <optional>
#include <string>

namespace lagroid::optimisation {

struct GradientDescentOptions {
  /// X+ = R_X(-step grad f). With neither `step` nor `c` by a line search, from twice the last step down until f has
  /// fallen by `decrease` of what the slope promises (Armijo).
  double step = 0;
  double c = 0;  ///< step = c / L
  double decrease = 1e-4;
  std::optional<ManifoldRetraction> retraction = {};  ///< without it qr or, where that is not offered, the exponential
};

class GradientDescent final : public DescentMethod {
 public:
  /// Throws std::invalid_argument, with the remedy, for options out of range.
  explicit GradientDescent(GradientDescentOptions options);

  std::string name() const override;
  void begin(Problem& problem, const EvaluatedPoint& state) override;
  StepOutcome advance(Problem& problem, EvaluatedPoint& state) override;

 private:
  GradientDescentOptions options_;
  ManifoldRetraction retraction_ = ManifoldRetraction::qr;
  double step_ = 0;
  double last_ = 0;
  Vector v_;
  Point to_;
};

}  // namespace lagroid::optimisation
