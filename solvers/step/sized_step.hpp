#pragma once
/// A one-step method (q, p) -> (q, p) on T*R^n, or on the part of it that constraints of places leave, whose n is known
/// when it runs.
///
///     SizedState z{q, p};
///     const StepReport report = step.take(z, /*t*/ 0, /*h*/ 0.1);
///
/// Momenta that differ by C'(q)^T nu are one. A step is a function of the state alone: what it begins to search from is
/// part of that. Errors: the report's status; the state stays as it was unless it is `converged`. Nothing throws.

#include <lagroid/solvers/step/step_solver.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace lagroid {

namespace detail {

/// The place on constraints that is near q: `rows` are C and its derivatives, a row each.
template <class Rows> Eigen::VectorXd place_on_constraints(const Rows& rows, Eigen::VectorXd q) {
  constexpr int passes = 20;
  for (int pass = 0; pass < passes; ++pass) {
    const Eigen::MatrixXd c = rows(q), slope = c.rightCols(q.size());
    q -= slope.transpose() * (slope * slope.transpose()).partialPivLu().solve(c.col(0));
  }
  return q;
}

/// Newton's iteration for equations whose number is known when it runs: until each is left with the rounding of its
/// terms. Unknown j is in units of `units(j)`.
struct SizedNewton {
  Eigen::VectorXd unknown{}, residual{}, terms{}, units{};
  Eigen::MatrixXd matrix{};

  void resize(Eigen::Index count);
  /// `write` writes residual, the sizes of its terms, matrix and units at `unknown`; what it wrote last is at the
  /// unknown that is left. `least` iterations ask the matrix whether it determines the unknown, even of a solution.
  template <class Write> StepReport solve(const Write& write, int least, int most) {
    constexpr double floor = 100;  // times its rounding is as far as some get
    StepReport report;
    double last = std::numeric_limits<double>::infinity();
    for (; report.iterations < most; ++report.iterations) {
      write();
      report.residual = residual.lpNorm<Eigen::Infinity>();
      report.roundoff_ratio = roundoff_ratio();
      if (!residual.allFinite() || !terms.allFinite() || !matrix.allFinite()) {
        report.status = SolveStatus::not_finite;
        return report;
      }
      if (report.iterations >= least &&
          (report.roundoff_ratio <= 1 || (report.roundoff_ratio <= floor && report.roundoff_ratio >= last / 2))) {
        report.status = SolveStatus::converged;
        return report;
      }
      last = report.roundoff_ratio;
      if (!find_update()) {
        report.status = SolveStatus::singular;
        return report;
      }
      unknown -= update_;
    }
    return report;
  }
  /// Of multipliers, the unknowns from `first` on: a unit that makes them as large as what they add to.
  double unit_of_multipliers(Eigen::Index first) const;

 private:
  /// Rows and columns are brought to one size. False where the matrix is singular.
  bool find_update();
  /// The largest residual over the rounding of its terms; infinite where that is nothing.
  double roundoff_ratio() const;

  Eigen::VectorXd update_{};
  Eigen::PartialPivLU<Eigen::MatrixXd> factor_{};
};

}  // namespace detail

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
  detail::SizedNewton newton{};  ///< where it is computed
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

/// Steps gamma_i h one after the other, by each of some methods in turn, or none.
class ComposedSizedStep : public SizedStep {
 public:
  ComposedSizedStep(std::vector<std::unique_ptr<SizedStep>> methods, std::vector<double> gammas)
      : methods_(std::move(methods)), gammas_(std::move(gammas)) {}

  StepReport take(SizedState& z, double t, double h) override;
  bool linearise(SizedState& z, double t, double h, std::vector<SizedSlopes>& stages) override;
  void find_velocity(const SizedState& z, double t, TangentState& out) const override {
    methods_.front()->find_velocity(z, t, out);
  }

 private:
  SizedStep& method_of(std::size_t stage) { return *methods_[stage % methods_.size()]; }

  std::vector<std::unique_ptr<SizedStep>> methods_;
  std::vector<double> gammas_;
  SizedState trial_;
};

}  // namespace lagroid
