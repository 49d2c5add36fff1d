#pragma once
/// Newton's iteration for one implicit step, on the source fibre of the groupoid:
///
///     g <- g tau(w),    lambda <- lambda + dlambda,    (w, dlambda) = -J^{-1} r(g, lambda),
///
/// r the step equations (step_solver.hpp) and J their matrix. It is the default solver: its iterates never leave the
/// fibre, and it stops at round-off, not at a tolerance, so that long runs do not drift by what the solver leaves.
///
///     NewtonStep<Kepler> newton({.max_iterations = 20});
///     StepSolution<Kepler> found{{Pair<2>::unit(Vector<double, 2>(1, 0)), {}}, {}};
///     const StepReport report = newton.solve(Kepler{}, {{1, 0}, {0, 1}}, found);
///
/// Requires a guess whose arrow starts at the object of the state; one solver serves one trajectory, because it keeps a
/// matrix from step to step. Status: `singular` ([G] Def. 3.5), `stagnated`, `not_converged`, `not_finite`,
/// `left_domain` (a solution that the system's `admissible` rejects). [N] (3.5), from Lie groups to source fibres.

#include <lagroid/solvers/linear_algebra/factored_square.hpp>
#include <lagroid/solvers/linear_algebra/small_inverse.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid {

struct NewtonOptions {
  int max_iterations = 60;
  int max_halvings = 12;  ///< of a Newton step that would increase the residual
  /// A residual that stagnates is accepted up to this many times its round-off level.
  double accept_roundoff_ratio = 100;
  double tolerance = 0;  ///< a scaled residual this small is accepted too; 0: iterate to round-off
};

/// Version 1 of the Newton iteration ([N] (3.5)), from Lie groups to source fibres: g <- g tau(w), lambda <- lambda +
/// dlambda, with (w, dlambda) from the matrix of `StepEquations`. Unknowns and equations are scaled to a matrix with
/// entries near one. Iterates to the round-off level of every equation, and on until what the iteration itself leaves
/// is well below that: it is not random, and would add up over a long run. No allocation.
///
/// A step whose guess is good (the next one of a smooth trajectory) takes chord Newton: iterations with the inverse of
/// a matrix that is renewed only when that saves time, gradients alone being evaluated. Whenever these do not contract,
/// the solve starts again from the guess with a full Newton iteration, damped so that the residual falls.
template <DiscreteSystem Sys> class NewtonStep final : public StepSolver<Sys> {
 public:
  using G = typename Sys::GroupoidType;

  explicit NewtonStep(NewtonOptions options = {}) : options_(options) {}

  StepReport solve(const Sys& system, const State<G>& state, StepSolution<Sys>& solution) override;
  void serialize(NumberArchive& archive) override;

 private:
  using E = StepEquations<Sys>;
  using Residual = typename E::Residual;
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();
  static constexpr double iteration_error = 0.1;  ///< of a round-off level: what the iteration may leave
  static constexpr int longest_chord = 12;
  static constexpr int longest_idling = 3;  ///< full iterations near round-off that bring it no nearer
  static constexpr int renewal_price = E::size > 4 ? 2 : 1;

  /// What is known of the convergence of chord iterations.
  struct Chord {
    bool kept = false;              ///< there is an inverse to iterate with
    typename E::Jacobian jacobian;  ///< as evaluated; the inverse is NewtonStep::inverse_
    Residual floor;                 ///< reciprocal round-off level of each equation, at this solve's guess
    double first = 0;               ///< round-off ratio at the guess of the last solve
    double rate = 0;                ///< contraction of an iteration, as last seen
    int age = 0;                    ///< solves since the matrix was evaluated
    int iterations = 0;             ///< of the last solve
  };

  bool by_chords(const Sys& system, const State<G>& state, StepSolution<Sys>& solution, StepReport& report);
  bool renewal_pays() const;
  bool renew(const typename E::Jacobian& jacobian);
  void keep(const typename E::Jacobian& jacobian);
  typename E::Jacobian by_newton(const Sys& system, const State<G>& state, StepSolution<Sys>& solution,
                                 StepReport& report);
  Residual corrected(const ScaledResidual<Sys>& at) const;

  double norm_of(const Residual& residual) const { return largest_product(residual, scaling_.row); }
  double roundoff_ratio_of(const Residual& residual) const { return largest_product(residual, chord_.floor); }
  /// max_i |a_i b_i|
  template <class A> static double largest_product(const Residual& a, const A& b) {
    double largest = std::abs(a(0) * b(0));
    unrolled<E::size - 1>([&]<int I>() { largest = std::max(largest, std::abs(a(I + 1) * b(I + 1))); });
    return largest;
  }

  static void move(const Sys& system, Step<Sys>& step, const Residual& correction) {
    // Copied, not moved or constructed: Eigen moves its storage in pieces larger than the stores they must wait for.
    const ArrowOf<G> there = system.groupoid.extend(step.arrow, of_the_arrow(correction));
    step.arrow = there;
    unrolled<Sys::constraints>([&]<int I>() { step.multipliers(I) += correction(Sys::dimension + I); });
  }
  static AlgebroidVector<G> of_the_arrow(const Residual& correction) {
    AlgebroidVector<G> out;
    unrolled<Sys::dimension>([&]<int I>() { out(I) = correction(I); });
    return out;
  }
  static Step<Sys> moved(const Sys& system, Step<Sys> step, const Residual& correction) {
    move(system, step, correction);
    return step;
  }

  static void finish(StepReport& report, const Sys& system, const Step<Sys>& step) {
    report.status = SolveStatus::converged;
    if constexpr (HasBranch<Sys>) {
      if (!system.admissible(step.arrow)) report.status = SolveStatus::left_domain;
    }
  }

  NewtonOptions options_;
  Scaling<E::size> scaling_;
  SmallInverse<E::size> inverse_;
  Chord chord_;
  FactoredSquare<E::size> lu_;
};

template <DiscreteSystem Sys>
StepReport NewtonStep<Sys>::solve(const Sys& system, const State<G>& state, StepSolution<Sys>& solution) {
  StepReport report;
  if (chord_.kept) {
    if (by_chords(system, state, solution, report)) return report;
    chord_.kept = false;
  }
  const typename E::Jacobian jacobian = by_newton(system, state, solution, report);
  if (report.converged()) keep(jacobian);
  return report;
}

template <DiscreteSystem Sys> void NewtonStep<Sys>::serialize(NumberArchive& archive) {
  archive(chord_.kept);
  if (!chord_.kept) return;
  archive(chord_.jacobian, chord_.first, chord_.rate, chord_.age, chord_.iterations);
  archive(scaling_.row, scaling_.column, inverse_);
}

// ---- chord Newton

template <DiscreteSystem Sys>
LAGROID_FLATTEN bool NewtonStep<Sys>::by_chords(const Sys& system, const State<G>& state, StepSolution<Sys>& solution,
                                                StepReport& report) {
  Step<Sys> step;
  step = solution.step;
  Residual residual;
  if (renewal_pays()) {
    const TwoSidedOf<Sys> d = two_sided(system, step.arrow, step.multipliers);
    if (!renew(E::jacobian(d))) return false;
    residual = E::residual(d, state.momentum);
  } else {
    ++chord_.age;
    const GradientsOf<Sys> d = gradients(system, step.arrow, step.multipliers);
    residual = E::residual(d, state.momentum);
  }
  // The level follows the step even where the matrix does not: terms may shrink along the trajectory.
  const Residual level = round_off_level(system, state, step, chord_.jacobian);
  bool measured = true;
  unrolled<E::size>([&]<int I>() {
    chord_.floor(I) = 1 / level(I);
    measured = measured && chord_.floor(I) > 0;
  });
  if (!measured) return false;  // of a level that overflows
  double roundoff_ratio = roundoff_ratio_of(residual);
  chord_.first = roundoff_ratio;
  double rate = chord_.age == 0 ? std::min(0.1, 10 * epsilon * roundoff_ratio) : chord_.rate;
  double remains = roundoff_ratio;
  for (int iteration = 1; iteration <= std::min(longest_chord, options_.max_iterations); ++iteration) {
    report.iterations = iteration;
    move(system, step, inverse_.correction(residual));
    const GradientsOf<Sys> there = gradients(system, step.arrow, step.multipliers);
    residual = E::residual(there, state.momentum);
    const double next = roundoff_ratio_of(residual);
    if (!(next <= std::max(1.0, 0.3 * roundoff_ratio))) return false;
    if (next > 10) rate = std::max(next / roundoff_ratio, iteration == 1 ? 0 : rate);
    remains *= rate;
    roundoff_ratio = next;
    const bool tolerated = options_.tolerance > 0 && norm_of(residual) <= options_.tolerance;
    if ((roundoff_ratio <= 1 && remains <= iteration_error) || tolerated) {
      finish(report, system, step);
      bool finite = true;
      unrolled<E::size>([&]<int I>() { finite = finite && std::isfinite(residual(I)); });
      if (!report.converged() || !finite) return false;
      chord_.rate = rate;
      chord_.iterations = iteration;
      solution.step = step;
      const Residual correction = inverse_.correction(residual);
      solution.remainder = of_the_arrow(correction);
      solution.momentum_change = momentum_change(system, step, there);
      report.residual = norm_of(residual);
      report.roundoff_ratio = roundoff_ratio;
      return true;
    }
  }
  return false;
}

/// Whether a new matrix costs less than the iterations it would save. One costs about as much as `renewal_price`
/// chord iterations.
template <DiscreteSystem Sys> bool NewtonStep<Sys>::renewal_pays() const {
  if (chord_.iterations <= 1 + renewal_price) return false;
  const auto iterations = [&](double rate) {
    int count = 0;
    for (double e = chord_.first; e > iteration_error && count < longest_chord; e *= rate) ++count;
    return count;
  };
  const double ageing = chord_.age == 0 ? 1 : double(chord_.age + 1) / chord_.age;
  const double kept = std::max(chord_.rate * ageing, 1e-3);
  return iterations(kept) > iterations(std::min(0.1, 10 * epsilon * chord_.first)) + renewal_price;
}

/// The inverse of the matrix at a step; false where scaling, pivots or the system itself are not good enough.
template <DiscreteSystem Sys> [[gnu::noinline]] bool NewtonStep<Sys>::renew(const typename E::Jacobian& jacobian) {
  chord_.jacobian = jacobian;
  chord_.age = 0;
  return inverse_.invert(jacobian);
}

/// After a full solve: the matrix there, for the steps that follow.
template <DiscreteSystem Sys> [[gnu::cold]] void NewtonStep<Sys>::keep(const typename E::Jacobian& jacobian) {
  inverse_.choose_pivots(jacobian, scaling_);
  chord_.kept = renew(jacobian);
  chord_.first = 1e12;
  chord_.rate = 0.1;
  chord_.age = 1;
  chord_.iterations = longest_chord;
}

// ---- damped Newton

/// Returns the matrix at the step it ends at.
template <DiscreteSystem Sys>
[[gnu::cold, gnu::noinline]] auto NewtonStep<Sys>::by_newton(const Sys& system, const State<G>& state,
                                                             StepSolution<Sys>& solution, StepReport& report) ->
    typename E::Jacobian {
  Step<Sys>& step = solution.step;
  auto derivative = two_sided(system, step.arrow, step.multipliers);
  ScaledResidual<Sys> current(system, state, step, derivative, scaling_, /*rescale=*/true);
  const auto at = [&](SolveStatus status, const Residual& correction) {
    solution.momentum_change = momentum_change(system, step, derivative);
    solution.remainder = of_the_arrow(correction);
    report.residual = current.norm;
    report.roundoff_ratio = current.roundoff_ratio;
    report.status = status;
    if (status == SolveStatus::converged) finish(report, system, step);
    return current.jacobian;
  };
  Residual none;
  for (double& x : none) x = 0;
  double least = current.roundoff_ratio;
  int idle = 0;
  for (const int before = report.iterations;; ++report.iterations) {
    if (!std::isfinite(current.norm)) return at(SolveStatus::not_finite, none);
    lu_.compute(scaling_.apply(current.jacobian));
    if (!(lu_.rcond() > 1e-15)) return at(SolveStatus::singular, none);
    const Residual correction = corrected(current);
    if (current.roundoff_ratio <= 1 || current.norm <= options_.tolerance) {
      const Step<Sys> once_more = moved(system, step, correction);
      const auto d = two_sided(system, once_more.arrow, once_more.multipliers);
      const ScaledResidual<Sys> next(system, state, once_more, d, scaling_, /*rescale=*/false);
      if (next.roundoff_ratio >= current.roundoff_ratio) return at(SolveStatus::converged, correction);
      step = once_more;
      derivative = d;
      current = next;
      return at(SolveStatus::converged, corrected(current));
    }
    if (report.iterations - before == options_.max_iterations) return at(SolveStatus::not_converged, none);

    bool advanced = false;
    double fraction = 1;
    for (int halving = 0; halving <= options_.max_halvings && !advanced; ++halving, fraction /= 2) {
      Residual part = correction;
      for (double& x : part) x *= fraction;
      const Step<Sys> trial = moved(system, step, part);
      const auto d = two_sided(system, trial.arrow, trial.multipliers);
      const ScaledResidual<Sys> next(system, state, trial, d, scaling_, /*rescale=*/false);
      if (next.norm < current.norm || next.roundoff_ratio < current.roundoff_ratio) {
        advanced = true;
        step = trial;
        derivative = d;
        current = next;
      } else if (current.roundoff_ratio <= options_.accept_roundoff_ratio) {
        return at(SolveStatus::converged, correction);
      }
    }
    if (!advanced) return at(SolveStatus::stagnated, none);
    // At round-off the norm and the ratio may fall in turn for ever.
    idle = current.roundoff_ratio < least ? 0 : idle + 1;
    least = std::min(least, current.roundoff_ratio);
    if (idle >= longest_idling && current.roundoff_ratio <= options_.accept_roundoff_ratio)
      return at(SolveStatus::converged, corrected(current));
  }
}

/// The Newton correction for a residual, with the factors at hand.
template <DiscreteSystem Sys> auto NewtonStep<Sys>::corrected(const ScaledResidual<Sys>& at) const -> Residual {
  Residual right;
  for (int i = 0; i < E::size; ++i) right(i) = at.residual(i) * scaling_.row(i);
  Residual out = lu_.solve(right);
  for (int i = 0; i < E::size; ++i) out(i) = -(out(i) * scaling_.column(i));
  return out;
}

}  // namespace lagroid
