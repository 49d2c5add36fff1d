#pragma once
/// One-step maps on Poisson manifolds, x -> Phi_h(x): implicit ones by Newton's method with a typed outcome, and
/// explicit ones by splittings and Runge-Kutta.
///
///     const FormulaStep<GroupoidFormula<FrozenChart<LotkaVolterra>>> step;
///     Vector<double, 2> end;
///     const StepReport report = step.take(Vector<double, 2>(2, 0.5), 0.1, end);
///     const auto slope = step.slope(Vector<double, 2>(2, 0.5), 0.1);  // d Phi_h, by x
///
/// `slope(x, h, members)` has after the columns by x those by members of the very system that the step has
/// (`system()`); its formulas read them by `varied`. Not a number where there is no step.
///
/// Outcomes: `left_domain` where a flow is not known to round-off any more or the energy's domain ends, `singular` at a
/// fold, where the determinant of the step's equations has passed zero, `not_converged`, `not_finite`. Nothing is
/// allocated in a step, though in a slope; nothing throws.

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/solvers/poisson/formulas.hpp>
#include <lagroid/solvers/poisson/levels.hpp>
#include <lagroid/solvers/status.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid {

/// A derivative of a step: columns by the point, and then by members.
template <int N> using StepSlope = Matrix<double, N, Eigen::Dynamic>;

/// That of a step that is not there.
template <int N> StepSlope<N> unknown_slope(int columns) {
  return StepSlope<N>::Constant(N, columns, std::numeric_limits<double>::quiet_NaN());
}

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
  const auto& system() const { return formula.system(); }
  /// By the implicit function theorem.
  StepSlope<size> slope(const X& x, double h, std::span<const double* const> members = {}) const {
    const int others = size + int(members.size());
    StepSlope<size> residual(size, size + others);  // by u, x and members
    StepSlope<size> reached(size, size + others);
    X u;
    X end;
    bool known = solve(x, h, u, end).converged();
    if (!known) return unknown_slope<size>(others);
    detail::for_directions(size + others, [&](int first) {
      const VariedMembers varying(members, 2 * size - first);
      const auto at = formula.at(detail::varied_along(x, size - first), h, detail::varied_along(u, -first));
      known = known && at.known;
      if (!known) return;
      detail::put_tangents(at.residual, first, residual);
      detail::put_tangents(at.end, first, reached);
    });
    if (!known) return unknown_slope<size>(others);
    Square of_u = residual.leftCols(size);
    StepSlope<size> u_by_others = residual.rightCols(others);
    eliminate(of_u, u_by_others);
    return reached.rightCols(others) - reached.leftCols(size) * u_by_others;
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

/// The step to y, and from there along the gradients of the Casimirs at y to the point where they have their old
/// values,
///
///     z = y + G(y)^T l,    C(z) = C(x),
///
/// by Newton's method for l, which has no part in the derivative (levels.hpp).
template <class Step> class ProjectedStep {
 public:
  static constexpr int size = Step::size;
  using X = Vector<double, size>;
  Step step;

  explicit ProjectedStep(Step of = Step()) : step(std::move(of)) {}
  const auto& system() const { return step.system(); }
  static constexpr KeptStructure kept{Step::kept.bracket, 0};
  static constexpr int order = Step::order;
  static constexpr bool symmetric = false;
  static constexpr bool explicit_step = false;

  StepReport take(const X& x, double h, X& end) const {
    StepReport report = step.take(x, h, end);
    lead_back(x, end, report);
    return report;
  }
  StepSlope<size> slope(const X& x, double h, std::span<const double* const> members = {}) const {
    using OnLevels = Levels<std::remove_cvref_t<decltype(system())>, false>;
    X y;
    StepReport report = step.take(x, h, y);
    X z = y;
    lead_back(x, z, report);
    if (!report.converged()) return unknown_slope<size>(size + int(members.size()));
    return OnLevels::slope_of_way(system(), y, z, step.slope(x, h, members),
                                  OnLevels::slope_of_values(system(), x, members), members, 0);
  }

 private:
  /// y, where a step that converged ends, becomes z.
  void lead_back(const X& x, X& end, StepReport& report) const {
    const auto& system = this->system();
    using Sys = std::remove_cvref_t<decltype(system)>;
    if constexpr (casimir_count<Sys>() > 0) {
      constexpr int count = casimir_count<Sys>();
      using J = Jet<double, size>;
      const Vector<double, count> wanted = system.casimirs(x);
      Matrix<double, count, size> along;
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
        if (pass == 0) along = slope;
        square = slope * along.transpose();
        if (eliminate(square, gap) == 0) report.status = SolveStatus::singular;
        end += along.transpose() * gap;
      }
    }
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

  StepReport take(const X& x, double h, X& end) const { return take(x, std::span(&h, 1), end); }
  /// Steps of these sizes, one after another: where one ends and the next begins the same part moves x.
  StepReport take(const X& x, std::span<const double> sizes, X& end) const {
    bool known = true;
    end = map(x, sizes, known);
    const bool good = known && end.allFinite();
    return {good ? SolveStatus::converged : known ? SolveStatus::not_finite : SolveStatus::left_domain, 1, 0, 0};
  }
  const auto& system() const { return chart.system; }
  StepSlope<size> slope(const X& x, double h, std::span<const double* const> members = {}) const {
    bool known = true;
    const StepSlope<size> found =
        varied_jacobian<size>([&](const auto& y) { return map(y, std::span(&h, 1), known); }, x, members);
    return known ? found : unknown_slope<size>(int(found.cols()));
  }

 private:
  template <class S> Vector<S, size> map(Vector<S, size> x, std::span<const double> sizes, bool& known) const {
    constexpr int last = std::remove_cvref_t<decltype(chart.system)>::parts - 1;
    const auto flow = [&](int i, double time) {
      known = flow_of_form(chart, i, S(part_slope(i, x) * time), x) && known;
    };
    double first = 0;  // how long the part that steps begin and end with has to move x
    for (const double h : sizes) {
      if (last > 0) flow(0, first + 0.5 * h);
      for (int i = 1; i < last; ++i) flow(i, 0.5 * h);
      flow(last, h);
      for (int i = last; --i > 0;) flow(i, 0.5 * h);
      first = 0.5 * h;
    }
    if (last > 0) flow(0, first);
    return x;
  }
  /// H_i' at <l_i, x>.
  template <class S> S part_slope(int i, const Vector<S, size>& x) const {
    const auto& of = chart.system;
    S along(0.0);
    if constexpr (HasAxesAsForms<std::remove_cvref_t<decltype(of)>>) {
      along = x(i);
    } else {
      const X form = of.form(i);
      for (int j = 0; j < size; ++j)
        if (form(j) != 0) along += x(j) * form(j);
    }
    if constexpr (requires { of.part_slope(i, along); }) {
      return of.part_slope(i, along);
    } else {
      return of.part(i, Dual<S>(along, S(1.0))).derivative;
    }
  }
};

/// The classical method of order 4, to compare with.
template <class Sys> class PoissonRungeKuttaStep {
 public:
  static constexpr int size = Sys::dimension;
  using X = Vector<double, size>;

  explicit PoissonRungeKuttaStep(Sys of = {}) : system_(std::move(of)) {}
  static constexpr KeptStructure kept{5, 5};
  static constexpr int order = 4;
  static constexpr bool symmetric = false;
  static constexpr bool explicit_step = true;

  StepReport take(const X& x, double h, X& end) const {
    end = map(x, h);
    return {end.allFinite() ? SolveStatus::converged : SolveStatus::not_finite, 1, 0, 0};
  }
  const Sys& system() const { return system_; }
  StepSlope<size> slope(const X& x, double h, std::span<const double* const> members = {}) const {
    return varied_jacobian<size>([&](const auto& y) { return map(y, h); }, x, members);
  }

 private:
  template <class S> Vector<S, size> map(const Vector<S, size>& x, double h) const {
    const Vector<S, size> k1 = system_.velocity(x);
    const Vector<S, size> k2 = system_.velocity(Vector<S, size>(x + k1 * S(0.5 * h)));
    const Vector<S, size> k3 = system_.velocity(Vector<S, size>(x + k2 * S(0.5 * h)));
    const Vector<S, size> k4 = system_.velocity(Vector<S, size>(x + k3 * S(h)));
    return x + (k1 + k2 * S(2.0) + k3 * S(2.0) + k4) * S(h / 6);
  }

  Sys system_;
};

}  // namespace lagroid
