#pragma once
/// A Lagrangian on R^n that is written as text, with constraints of places, forces and symmetries: what a scene has
/// under [lagrangian].
///
///     const FormulaLagrangian pendulum({.coordinates = {"q"}, .parameters = {{"m", 1}, {"l", 1}, {"g", 9.81}}},
///                                      "m*l^2*q'^2/2 + m*g*l*cos(q)");
///     std::vector<double> out(pendulum.lagrangian_numbers());
///     pendulum.lagrangian(0, q, v, out.data());  // and its derivatives, exact
///
/// A coordinate x has the velocity x'; `t` is the time. Derivatives are formulas of the same graph (formula_graph.hpp),
/// compiled to one list of operations.
///
/// Errors: FormulaError.

#include <lagroid/run/formula/formula_system.hpp>
#include <lagroid/solvers/galerkin/sized_lagrangian.hpp>

#include <memory>
#include <string>
#include <vector>

namespace lagroid {

class FormulaLagrangian final : public SizedLagrangian, public FormulaSystem {
 public:
  explicit FormulaLagrangian(const FormulaTexts& texts, const std::string& lagrangian,
                             const std::vector<std::string>& force = {});

  bool keeps_energy() const override { return !depends_on_time_ && !sizes().forced; }
  const char* energy_is() const override { return "<dl/dv, v> - l"; }

  std::unique_ptr<FormulaSystem> clone() const override { return std::make_unique<FormulaLagrangian>(*this); }
  void energy_slope(double t, const double* q, const double* p, const double* v, double* out) const override;
  Eigen::MatrixXd velocity_slope(double t, const double* q, const double* p, const double* v) const override;
  /// The derivatives of l_v by q, v and the parameters, a row for each component.
  Eigen::MatrixXd momentum_slope(double t, const double* q, const double* v) const;

  void lagrangian(double t, const double* q, const double* v, double* out) const override;
  void constraint(const double* q, double* out) const override { FormulaSystem::constraint(q, out); }
  void force(double t, const double* q, const double* v, double* out) const override;
  void by_parameters(double t, const double* q, const double* v, double* out) const override;

 private:
  bool depends_on_time_ = false;
  FormulaProgram lagrangian_, force_, by_parameters_;
};

}  // namespace lagroid
