#pragma once
/// The Riemannian trust region method: each step minimises
///
///     m(v) = f + <grad f, v> + <v, Hess f v> / 2,    |v| <= radius.
///
/// It converges faster than linearly near a minimum, at the price of Hessians times vectors.
///
///     using namespace optimisation;
///     TrustRegion method;
///     const Result found = minimise(Sphere(3), Height(), Eigen::Vector3d(1, 0, 0), method, {.gradient = 1e-9});
///
/// (`Height` stands in objective.hpp.) Requires a retraction that the manifold offers. (Absil, Baker and Gallivan,
/// Found. Comput. Math. 7 (2007) 303.)

#include <lagroid/solvers/optimisation/minimise.hpp>

#include <optional>
#include <string>

namespace lagroid::optimisation {

struct TrustRegionOptions {
  std::optional<ManifoldRetraction> retraction = {};  ///< without it qr or, where that is not offered, the exponential
  double first_radius = 0;                            ///< 0: an eighth of the largest
  double largest_radius = 0;  ///< 0: the square root of the dimension, about the size of the manifold
  int inner_iterations = 0;   ///< 0: the dimension
};

/// Minimises m(v) = f + <grad f, v> + <v, Hess f v> / 2 within |v| <= radius by truncated conjugate gradients
/// (Steihaug and Toint), until the residual is |r_0| min(|r_0| / |grad f at the start|, 0.1); f has to fall by a tenth
/// of what m promises.
class TrustRegion final : public DescentMethod {
 public:
  explicit TrustRegion(TrustRegionOptions options = {}) : options_(options) {}

  std::string name() const override { return "trust region"; }
  void begin(Problem& problem, const EvaluatedPoint& state) override;
  StepOutcome advance(Problem& problem, EvaluatedPoint& state) override;

 private:
  void solve_model(Problem& problem, const EvaluatedPoint& state);

  TrustRegionOptions options_;
  ManifoldRetraction retraction_ = ManifoldRetraction::qr;
  double radius_ = 0;
  double largest_ = 0;
  double first_gradient_ = 0;
  Vector step_, next_step_, curved_step_, residual_, direction_, curved_;
  Point to_;
};

}  // namespace lagroid::optimisation
