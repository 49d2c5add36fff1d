#pragma once
/// A one-step method (q, p) -> (q, p) on T*R^n, or on the part of it that constraints of places leave, whose n is known
/// when it runs.
///
///     Eigen::VectorXd q(1), p(1);
///     const StepReport report = step.take(q, p, /*t*/ 0, /*h*/ 0.1);
///
/// Momenta that differ by C'(q)^T nu are one. Errors: the report's status; q and p stay as they were unless it is
/// `converged`. Nothing throws.

#include <lagroid/solvers/step/step_solver.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>
#include <cstddef>
#include <limits>

namespace lagroid {

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
  Eigen::VectorXd residual{}, update{};
  Eigen::PartialPivLU<Eigen::MatrixXd> factor{};
};

class SizedStep {
 public:
  virtual ~SizedStep() = default;
  /// A step h of either sign, not zero, at the time t.
  virtual StepReport take(Eigen::VectorXd& q, Eigen::VectorXd& p, double t, double h) = 0;
  /// Goes on from the velocity that `out` has where it was found before.
  virtual void find_velocity(const Eigen::VectorXd& q, const Eigen::VectorXd& p, double t, TangentState& out) const = 0;
};

namespace detail {

/// matrix x = right, of rows brought to one size, in place. False where the matrix is singular.
bool solve_equilibrated(Eigen::PartialPivLU<Eigen::MatrixXd>& factor, Eigen::MatrixXd& matrix, Eigen::VectorXd& right,
                        Eigen::VectorXd& x);
/// The largest residual over the rounding of its terms; infinite where it is no number.
double roundoff_ratio(const Eigen::VectorXd& residual, const Eigen::VectorXd& terms);

/// The place of entry (i, j) in an upper triangle of `size` rows, row by row.
constexpr std::size_t in_triangle(int i, int j, int size) {
  const int row = i < j ? i : j, column = i < j ? j : i;
  return std::size_t(row * size - row * (row - 1) / 2 + column - row);
}

/// Newton's iteration for `unknown`: `write` writes residual, terms and matrix there; until each equation is left with
/// the rounding of its terms. The last equations written are those of the unknown that is left.
template <class Write>
StepReport newton_of_any_size(const Write& write, Eigen::VectorXd& unknown, Eigen::VectorXd& residual,
                              const Eigen::VectorXd& terms, Eigen::MatrixXd& matrix, Eigen::VectorXd& update,
                              Eigen::PartialPivLU<Eigen::MatrixXd>& factor) {
  constexpr int most_iterations = 50;
  constexpr double floor = 100;  // times its rounding is as far as some get
  StepReport report;
  double last = std::numeric_limits<double>::infinity();
  for (; report.iterations < most_iterations; ++report.iterations) {
    write();
    report.residual = residual.cwiseAbs().maxCoeff();
    report.roundoff_ratio = roundoff_ratio(residual, terms);
    if (!std::isfinite(report.roundoff_ratio) || !matrix.allFinite()) {
      report.status = SolveStatus::not_finite;
      return report;
    }
    if (report.roundoff_ratio <= 1 || (report.roundoff_ratio <= floor && report.roundoff_ratio >= last / 2)) {
      report.status = SolveStatus::converged;
      return report;
    }
    last = report.roundoff_ratio;
    if (!solve_equilibrated(factor, matrix, residual, update)) {
      report.status = SolveStatus::singular;
      return report;
    }
    unknown -= update;
  }
  return report;
}

}  // namespace detail

}  // namespace lagroid
