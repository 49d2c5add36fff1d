#pragma once
/// A one-step method (q, p) -> (q, p) on T*R^n, or on the part of it that constraints of places leave, whose n is known
/// when it runs.
///
///     SizedState z{q, p};
///     const StepReport report = step.take(z, /*t*/ 0, /*h*/ 0.1);
///
/// Momenta that differ by C'(q)^T nu are one. A step is a function of the state alone: what it begins to search from is
/// part of that. Errors: the report's status; the state stays as it was unless it is `converged`. Nothing throws.

#include <lagroid/solvers/integrators/composition.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace lagroid {

/// The velocity is the root of p = l_v + C'^T nu where Newton's method begins, which for an l that is not convex is one
/// of several; zero where it is left empty.
struct SizedState {
  Eigen::VectorXd position{};
  Eigen::VectorXd momentum{};
  Eigen::VectorXd velocity{};
};

/// The velocity that belongs to a momentum, C' v = 0, and of the momenta that are one the tangent one.
struct TangentState {
  Eigen::VectorXd velocity{};
  Eigen::VectorXd momentum{};
  double energy = 0;
  double energy_size = 0;  ///< of its terms
  bool found = false;
  // Where it is computed.
  Eigen::VectorXd nu{};
  Eigen::MatrixXd matrix{};
  Eigen::VectorXd residual{}, update{}, units{};
  Eigen::PartialPivLU<Eigen::MatrixXd> factor{};
};

/// A step linearised where it is solved, as LinearStep has it (linear_step.hpp): E(z; x) = 0 and x' = X(z; x), x = (q,
/// p, parameters).
struct SizedSlopes {
  Eigen::MatrixXd equations_by_unknowns;  ///< E_z
  Eigen::MatrixXd equations_by_start;     ///< E_x
  Eigen::MatrixXd end_by_unknowns;        ///< X_z
  Eigen::MatrixXd end_by_start;           ///< X_x
};

class SizedStep {
 public:
  virtual ~SizedStep() = default;
  /// A step h of either sign, not zero, at the time t.
  virtual StepReport take(SizedState& z, double t, double h) = 0;
  /// Takes a step that converges, of a system without constraints, and appends its slopes, those of each of its stages.
  /// False where it does not converge.
  virtual bool linearise(SizedState& z, double t, double h, std::vector<SizedSlopes>& stages) = 0;
  /// Begins at the velocity that the state has.
  virtual void find_velocity(const SizedState& z, double t, TangentState& out) const = 0;
};

/// The steps gamma_i h of a composition, or none.
class ComposedSizedStep final : public SizedStep {
 public:
  ComposedSizedStep(std::unique_ptr<SizedStep> step, const Composition& composition)
      : step_(std::move(step)), composition_(composition) {}

  StepReport take(SizedState& z, double t, double h) override;
  bool linearise(SizedState& z, double t, double h, std::vector<SizedSlopes>& stages) override;
  void find_velocity(const SizedState& z, double t, TangentState& out) const override {
    step_->find_velocity(z, t, out);
  }

 private:
  std::unique_ptr<SizedStep> step_;
  Composition composition_;
  SizedState trial_;
};

namespace detail {

/// matrix x = right, in place, unknown j in units of `units(j)`, rows and columns then brought to one size. False where
/// the matrix is singular.
bool solve_in_units(Eigen::PartialPivLU<Eigen::MatrixXd>& factor, Eigen::MatrixXd& matrix, Eigen::VectorXd& right,
                    Eigen::VectorXd& x, Eigen::VectorXd& units);
/// The unit of multipliers, in columns from `first` on, that makes them as large as what they add to.
double unit_of_multipliers(const Eigen::MatrixXd& matrix, Eigen::Index first);
/// The largest residual over the rounding of its terms; infinite where that is nothing.
double roundoff_ratio(const Eigen::VectorXd& residual, const Eigen::VectorXd& terms);

/// The place of entry (i, j) in an upper triangle of `size` rows, row by row.
constexpr std::size_t in_triangle(int i, int j, int size) {
  const int row = i < j ? i : j, column = i < j ? j : i;
  return std::size_t(row * size - row * (row - 1) / 2 + column - row);
}

/// Newton's iteration for `unknown`: `write` writes residual, terms, matrix and units there; until each equation is
/// left with the rounding of its terms. The last equations written are those of the unknown that is left.
template <class Write>
StepReport newton_of_any_size(const Write& write, Eigen::VectorXd& unknown, Eigen::VectorXd& residual,
                              const Eigen::VectorXd& terms, Eigen::MatrixXd& matrix, Eigen::VectorXd& update,
                              Eigen::VectorXd& units, Eigen::PartialPivLU<Eigen::MatrixXd>& factor) {
  constexpr int most_iterations = 50;
  constexpr double floor = 100;  // times its rounding is as far as some get
  StepReport report;
  double last = std::numeric_limits<double>::infinity();
  for (; report.iterations < most_iterations; ++report.iterations) {
    write();
    report.residual = residual.cwiseAbs().maxCoeff();
    report.roundoff_ratio = roundoff_ratio(residual, terms);
    if (!residual.allFinite() || !terms.allFinite() || !matrix.allFinite()) {
      report.status = SolveStatus::not_finite;
      return report;
    }
    if (report.roundoff_ratio <= 1 || (report.roundoff_ratio <= floor && report.roundoff_ratio >= last / 2)) {
      report.status = SolveStatus::converged;
      return report;
    }
    last = report.roundoff_ratio;
    if (!solve_in_units(factor, matrix, residual, update, units)) {
      report.status = SolveStatus::singular;
      return report;
    }
    unknown -= update;
  }
  return report;
}

}  // namespace detail

}  // namespace lagroid
