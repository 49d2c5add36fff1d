#pragma once
/// One-step maps on Poisson manifolds, x -> Phi_h(x): implicit ones by Newton's method with a typed outcome, and
/// explicit ones by splittings and Runge-Kutta.
///
///     const FormulaStep<GroupoidFormula<FrozenChart<LotkaVolterra>>> step;
///     Vector<double, 2> end;
///     const StepReport report = step.take(Vector<double, 2>(2, 0.5), 0.1, end);
///     const Matrix<double, 2, 2> slope = step.slope(Vector<double, 2>(2, 0.5), 0.1);  // d Phi_h
///
/// Outcomes: `left_domain` where a flow is not known to round-off any more or the energy's domain ends, `singular` at a
/// fold, where the determinant of the step's equations has passed zero, `not_converged`, `not_finite`. Nothing is
/// allocated in a step, nothing throws.

#include <lagroid/solvers/poisson/formulas.hpp>
#include <lagroid/solvers/status.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid {

/// Solves a formula by Newton's method, with a matrix that is kept as long as the residual falls tenfold.
template <class Formula> class FormulaStep {
 public:
  static constexpr int size = Formula::size;
  using X = Vector<double, size>;
  using Square = Matrix<double, size, size>;
  Formula formula;

  explicit FormulaStep(Formula of = Formula()) : formula(std::move(of)) {}
  static constexpr KeptStructure kept = Formula::kept;
  static constexpr int order = Formula::order;
  static constexpr bool symmetric = true;
  static constexpr bool explicit_step = false;

  StepReport take(const X& x, double h, X& end) const {
    X u;
    return solve(x, h, u, end);
  }
  /// d Phi_h(x), by the implicit function theorem; not a number where there is no step.
  Square slope(const X& x, double h) const {
    X u;
    X end;
    Square of_u;
    Square of_x;
    Square end_of_u;
    Square end_of_x;
    if (!solve(x, h, u, end).converged()) return Square::Constant(std::numeric_limits<double>::quiet_NaN());
    for (int k = 0; k < size; ++k) {
      const X unit = X::Unit(k);
      const X zero = X::Zero();
      const auto by_u = formula.at(moved_along(x, zero), h, moved_along(u, unit));
      const auto by_x = formula.at(moved_along(x, unit), h, moved_along(u, zero));
      for (int i = 0; i < size; ++i) {
        of_u(i, k) = by_u.residual(i).derivative;
        of_x(i, k) = by_x.residual(i).derivative;
        end_of_u(i, k) = by_u.end(i).derivative;
        end_of_x(i, k) = by_x.end(i).derivative;
      }
    }
    eliminate(of_u, of_x);
    return end_of_x - end_of_u * of_x;
  }

 private:
  static constexpr int most_iterations = 40;
  static constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  static constexpr double floor = 250;  // times its rounding is as far as some residuals get

  /// The determinant of the matrix; `inverse` is that of it.
  double invert(const X& x, double h, const X& u, Square& inverse) const {
    Square matrix = formula.slope(x, h, u);
    inverse = Square::Identity();
    return eliminate(matrix, inverse);
  }
  StepReport solve(const X& x, double h, X& u, X& end) const {
    StepReport report;
    const auto ended = [&](SolveStatus status) {
      report.status = status;
      return report;
    };
    u = formula.guess(x, h);
    Square inverse;
    double determinant = invert(x, h, u, inverse);
    bool fresh = true;
    double last = INFINITY;
    for (report.iterations = 1; report.iterations <= most_iterations; ++report.iterations) {
      const auto at = formula.at(x, h, u);
      if (!u.allFinite()) return ended(SolveStatus::not_finite);
      if (!at.known) return ended(SolveStatus::left_domain);
      report.residual = at.residual.cwiseAbs().maxCoeff();
      if (!std::isfinite(report.residual)) return ended(SolveStatus::not_finite);
      const double round_off = rounding * u.cwiseAbs().maxCoeff();
      report.roundoff_ratio = round_off > 0 ? report.residual / round_off : 0;
      if (report.residual <= round_off || (report.residual <= floor * round_off && report.residual >= last / 2)) {
        end = at.end;
        return ended(determinant > 0 ? SolveStatus::converged : SolveStatus::singular);
      }
      if (!fresh && report.residual > 0.1 * last && report.residual > floor * round_off) {
        determinant = invert(x, h, u, inverse);
        fresh = true;
      } else {
        fresh = false;
      }
      if (!(std::abs(determinant) > 0)) return ended(SolveStatus::singular);
      last = report.residual;
      u -= inverse * at.residual;
    }
    return ended(SolveStatus::not_converged);
  }
};

/// The step, and then the nearest point on the Casimirs' old values, along their gradients at the new one.
template <class Step> class ProjectedStep {
 public:
  static constexpr int size = Step::size;
  using X = Vector<double, size>;
  Step step;

  explicit ProjectedStep(Step of = Step()) : step(std::move(of)) {}
  static constexpr KeptStructure kept{Step::kept.bracket, 0};
  static constexpr int order = Step::order;
  static constexpr bool symmetric = false;
  static constexpr bool explicit_step = false;

  StepReport take(const X& x, double h, X& end) const {
    const auto& system = step.formula.system();
    using Sys = std::remove_cvref_t<decltype(system)>;
    StepReport report = step.take(x, h, end);
    if constexpr (casimir_count<Sys>() > 0) {
      constexpr int count = casimir_count<Sys>();
      using J = Jet<double, size>;
      const Vector<double, count> wanted = system.casimirs(x);
      for (int pass = 0; report.converged() && pass < 4; ++pass) {
        Vector<J, size> at;
        for (int i = 0; i < size; ++i) at(i) = J::variable(end(i), i);
        const Vector<J, count> casimirs = system.casimirs(at);
        Matrix<double, count, size> slope;
        Matrix<double, count, count> square;
        Vector<double, count> gap;
        for (int c = 0; c < count; ++c) {
          slope.row(c) = casimirs(c).gradient().transpose();
          gap(c) = wanted(c) - casimirs(c).value;
        }
        square = slope * slope.transpose();
        if (eliminate(square, gap) == 0) report.status = SolveStatus::singular;
        end += slope.transpose() * gap;
      }
    }
    return report;
  }
};

/// Strang's splitting of H = sum_i H_i(<l_i, x>): each part moves x by the flow of a frozen momentum, which is
/// explicit.
template <class Chart> class SplitStep {
 public:
  static constexpr int size = Chart::size;
  using X = Vector<double, size>;
  Chart chart;

  explicit SplitStep(Chart of = Chart()) : chart(std::move(of)) {}
  static constexpr KeptStructure kept{};
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool explicit_step = true;

  StepReport take(const X& x, double h, X& end) const {
    bool known = true;
    end = map(x, h, known);
    const bool good = known && end.allFinite();
    return {good ? SolveStatus::converged : known ? SolveStatus::not_finite : SolveStatus::left_domain, 1, 0, 0};
  }
  Matrix<double, size, size> slope(const X& x, double h) const {
    bool known = true;
    return jacobian_of<size>([&](const auto& y) { return map(y, h, known); }, x);
  }

 private:
  template <class S> Vector<S, size> map(Vector<S, size> x, double h, bool& known) const {
    const auto& system = chart.system;
    constexpr int parts = std::remove_cvref_t<decltype(system)>::parts;
    for (int stage = 0; stage < 2 * parts - 1; ++stage) {
      const int i = stage < parts ? stage : 2 * parts - 2 - stage;
      const X form = system.form(i);
      S along(0.0);
      for (int j = 0; j < size; ++j)
        if (form(j) != 0) along += x(j) * form(j);
      const S rate = system.part(i, Dual<S>(along, S(1.0))).derivative * (i == parts - 1 ? h : 0.5 * h);
      const auto arc = linear_flow(chart, x, rate, form);
      known = known && arc.known;
      x = arc.end;
    }
    return x;
  }
};

/// The classical method of order 4, to compare with.
template <class Sys> class RungeKuttaStep {
 public:
  static constexpr int size = Sys::dimension;
  using X = Vector<double, size>;
  Sys system;

  explicit RungeKuttaStep(Sys of = {}) : system(std::move(of)) {}
  static constexpr KeptStructure kept{5, 5};
  static constexpr int order = 4;
  static constexpr bool symmetric = false;
  static constexpr bool explicit_step = true;

  StepReport take(const X& x, double h, X& end) const {
    end = map(x, h);
    return {end.allFinite() ? SolveStatus::converged : SolveStatus::not_finite, 1, 0, 0};
  }
  Matrix<double, size, size> slope(const X& x, double h) const {
    return jacobian_of<size>([&](const auto& y) { return map(y, h); }, x);
  }

 private:
  template <class S> Vector<S, size> map(const Vector<S, size>& x, double h) const {
    const Vector<S, size> k1 = system.velocity(x);
    const Vector<S, size> k2 = system.velocity(Vector<S, size>(x + k1 * S(0.5 * h)));
    const Vector<S, size> k3 = system.velocity(Vector<S, size>(x + k2 * S(0.5 * h)));
    const Vector<S, size> k4 = system.velocity(Vector<S, size>(x + k3 * S(h)));
    return x + (k1 + k2 * S(2.0) + k3 * S(2.0) + k4) * S(h / 6);
  }
};

}  // namespace lagroid
