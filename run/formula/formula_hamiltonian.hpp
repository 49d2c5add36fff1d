#pragma once
/// A Hamiltonian on T*R^n that is written as text, with constraints of places and symmetries, and its generating
/// functions of type II by Taylor's method of order r and a quadrature: what a scene has under [hamiltonian].
///
///     const FormulaHamiltonian spring({.coordinates = {"q"}}, {"p"}, "(p^2 + q^2)/2",
///                                     {1, quadrature_rules::trapezoid});
///     GeneratingStep step(spring, GeneratingType::two);  // Stormer-Verlet's
///
/// The Taylor coefficients, and the derivatives of the generating function, are formulas of the same graph.
///
/// Errors: FormulaError.
///
/// Source: [V] 5.4.1.

#include <lagroid/core/hamiltonian/quadrature_rule.hpp>
#include <lagroid/run/formula/formula_system.hpp>
#include <lagroid/solvers/generating/generating_step.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace lagroid {

/// Taylor's order r, 0 to 4, and the quadrature. The step's order is min(r + 1, that of the quadrature), with
/// constraints no more than two ([V] Theorem 5.1, docs/hamiltonian_maps.md); one for r = 0.
struct TaylorChoice {
  int order = 1;
  QuadratureRule quadrature = quadrature_rules::trapezoid;

  int step_order(bool constrained) const {
    const int free = order == 0 ? 1 : std::min(order + 1, quadrature.order);
    return constrained ? std::min(free, 2) : free;
  }
};

class FormulaHamiltonian final : public SizedHamiltonian, public FormulaSystem {
 public:
  FormulaHamiltonian(const FormulaTexts& texts, const std::vector<std::string>& momenta, const std::string& hamiltonian,
                     const TaylorChoice& taylor);

  bool keeps_energy() const override { return !depends_on_time_; }
  const char* energy_is() const override { return "H"; }

  std::unique_ptr<FormulaSystem> clone() const override { return std::make_unique<FormulaHamiltonian>(*this); }
  void energy_slope(double t, const double* q, const double* p, const double* v, double* out) const override;
  Eigen::MatrixXd velocity_slope(double t, const double* q, const double* p, const double* v) const override;

  void hamiltonian(double t, const double* q, const double* p, double* out) const override;
  void generating(double t, const double* q, const double* p, const double* sigma, const double* far, double h,
                  double* out) const override;
  void constraint(const double* q, double* out) const override { FormulaSystem::constraint(q, out); }
  void by_parameters(double t, const double* q, const double* p, const double* sigma, const double* far, double h,
                     double* out) const override;

 private:
  void read_generating_function(const FormulaTexts& texts, Node energy, const TaylorChoice& taylor);
  const double* generating_arguments(double t, const double* q, const double* p, const double* sigma, const double* far,
                                     double h) const;
  bool depends_on_time_;

  FormulaProgram hamiltonian_, energy_by_parameters_, velocity_by_parameters_, generating_, by_parameters_;
  mutable std::vector<double> arguments_;  ///< the variables, then sigma, p1 and h
};

}  // namespace lagroid
