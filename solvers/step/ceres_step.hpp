#pragma once
/// One implicit step as a least-squares problem for Ceres: min |r(g, lambda)|^2 / 2 over the source fibre and the
/// multipliers, r the scaled step equations (step_solver.hpp). It shares no code with NewtonStep beyond the equations,
/// and so checks it.
///
///     CeresStep<Kepler> ceres(50);  // iterations at most
///     StepSolution<Kepler> found{{Pair<2>::unit(Vector<double, 2>(1, 0)), {}}, {}};
///     const StepReport report = ceres.solve(Kepler{}, {{1, 0}, {0, 1}}, found);
///
/// Requires a guess whose arrow starts at the object of the state. Status: `stagnated` where the residual stays above
/// 1000 times its round-off and above the tolerance, `not_finite`, `left_domain`. The constructor throws MissingLibrary
/// in a build without Ceres.

#include <lagroid/solvers/newton/fibre_coordinates.hpp>
#include <lagroid/solvers/step/ceres_fibre.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <cmath>

namespace lagroid {

/// The same equations as `NewtonStep`, as a least-squares problem of zero residual on the source fibre, with tolerances
/// tight enough for momentum conservation. The Ceres problem is built once and reused. Ceres' own verdict is not used:
/// the status follows from the residual, evaluated anew.
template <DiscreteSystem Sys> class CeresStep final : public StepSolver<Sys> {
 public:
  using G = typename Sys::GroupoidType;
  using E = StepEquations<Sys>;

  explicit CeresStep(int max_iterations = 100, double tolerance = 0, const G& groupoid = {})
      : tolerance_(tolerance), equations_(groupoid), problem_(equations_, max_iterations) {}

  StepReport solve(const Sys& system, const State<G>& state, StepSolution<Sys>& solution) override {
    Step<Sys>& step = solution.step;
    StepReport report;
    const ScaledResidual<Sys> start(system, state, step, two_sided(system, step.arrow, step.multipliers),
                                    equations_.scaling, /*rescale=*/true);
    if (!std::isfinite(start.norm)) return end(report, SolveStatus::not_finite);
    equations_.system = &system;
    equations_.state = &state;
    Vector<double, Coordinates::ambient> arrow = system.groupoid.coordinates_of_arrow(step.arrow);
    report.iterations = problem_.solve(arrow.data(), step.multipliers.data());
    step.arrow = equations_.coordinates.arrow(arrow.data());
    const auto derivative = two_sided(system, step.arrow, step.multipliers);
    solution.momentum_change = momentum_change(system, step, derivative);
    const ScaledResidual<Sys> final(system, state, step, derivative, equations_.scaling, /*rescale=*/false);
    report.residual = final.norm;
    report.roundoff_ratio = final.roundoff_ratio;
    if (!std::isfinite(final.norm)) return end(report, SolveStatus::not_finite);
    if (!(final.roundoff_ratio <= accept_roundoff_ratio || final.norm <= tolerance_))
      return end(report, SolveStatus::stagnated);
    if constexpr (HasBranch<Sys>) {
      if (!system.admissible(step.arrow)) return end(report, SolveStatus::left_domain);
    }
    return end(report, SolveStatus::converged);
  }

 private:
  using Coordinates = SourceFibreCoordinates<G>;
  static constexpr double accept_roundoff_ratio = 1000;

  static StepReport end(StepReport report, SolveStatus status) {
    report.status = status;
    return report;
  }

  struct Equations final : FibreEquations {
    Coordinates coordinates;
    const Sys* system = nullptr;
    const State<G>* state = nullptr;
    Scaling<E::size> scaling;

    explicit Equations(const G& groupoid) : coordinates(groupoid) {}

    Sizes sizes() const override { return {Coordinates::ambient, Sys::dimension, Sys::constraints}; }
    bool plus(const double* g, const double* w, double* out) const override { return coordinates.plus(g, w, out); }
    void frame(const double* g, double* matrix) const override {
      Eigen::Map<Matrix<double, Coordinates::ambient, Sys::dimension>> out(matrix);
      out = coordinates.frame(coordinates.arrow(g));
    }
    bool evaluate(const double* at, const double* multipliers, double* residual, double* jacobian) const override {
      const auto g = coordinates.arrow(at);
      typename Sys::Multipliers lambda;
      for (int a = 0; a < Sys::constraints; ++a) lambda(a) = multipliers[a];
      const auto d = two_sided(*system, g, lambda);
      Eigen::Map<typename E::Residual> r(residual);
      r = E::residual(d, state->momentum).cwiseProduct(scaling.row);
      Eigen::Map<typename E::Jacobian> j(jacobian);
      j = scaling.row.asDiagonal() * E::jacobian(d);
      // A point without derivatives is no point to go on from: false makes Ceres try a shorter step.
      return r.allFinite() && j.allFinite();
    }
  };

  double tolerance_;
  Equations equations_;
  FibreProblem problem_;
};

}  // namespace lagroid
