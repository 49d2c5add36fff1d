#pragma once
/// The semi-implicit Euler discretisation of the Bregman Euler-Lagrange equations,
///
///     a = b_k V - h c_k grad f(X),    X+ = R_X(h a),    V+ = a, transported to X+.
///
/// To compare with accelerated.hpp, which discretises the same motions by symplectic maps.
///
///     using namespace optimisation;
///     EulerLagrange method({.p = 6, .h = 1e-3});
///     const Result found = minimise(Sphere(3), Height(), Eigen::Vector3d(1, 0, 0), method, {.gradient = 1e-9});
///
/// (`Height` stands in objective.hpp.) Options out of range throw std::invalid_argument, with the remedy. [V] Algorithm
/// 2

#include <lagroid/solvers/optimisation/minimise.hpp>

#include <optional>
#include <string>

namespace lagroid::optimisation {

struct EulerLagrangeOptions {
  double p = 6;
  double c = 1;  ///< C
  double h = 1e-3;
  std::optional<double> lambda = {};  ///< zeta / alpha, at least 1; without it zeta of the manifold
  int version = 1;                    ///< 2: the gradient is taken where the momentum alone would lead
  /// h^2 C p^2 (k h)^(p - 2) <= cap / L; infinite: it grows without end and loses convergence ([V] 5.5).
  double cap = 1;
  std::optional<ManifoldRetraction> retraction = {};  ///< without it qr or, where that is not offered, the exponential
  double diameter = 0;                                ///< of the domain, for zeta; 0: that of the manifold
};

/// For k = 1, 2, ..., b_k = 1 - (lambda p + 1) / k and c_k = C p^2 (k h)^(p - 2):
///
///     a = b_k V - h c_k grad f(X),   X+ = R_X(h a),   V+ = a transported,
///
/// version 2 with the gradient at R_X(h b_k V), transported back.
///
/// With lambda > 1 it begins at the first k with b_k >= 0, k = ceil(lambda p) + 1: the b_k before are negative, and the
/// product of their sizes reaches about 2^(lambda p). With lambda = 1 it begins at k = 1, as [V] does.
class EulerLagrange final : public DescentMethod {
 public:
  /// Throws std::invalid_argument, with the remedy, for options out of range.
  explicit EulerLagrange(EulerLagrangeOptions options);

  std::string name() const override;
  void begin(Problem& problem, const EvaluatedPoint& state) override;
  StepOutcome advance(Problem& problem, EvaluatedPoint& state) override;

 private:
  EulerLagrangeOptions options_;
  ManifoldRetraction retraction_ = ManifoldRetraction::qr;
  double lambda_ = 1;
  double k_ = 0;
  double largest_ = 0;
  Vector velocity_, v_;
  Point to_;
  EvaluatedPoint ahead_;
};

}  // namespace lagroid::optimisation
