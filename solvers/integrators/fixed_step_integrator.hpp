#pragma once
/// The one-step map of a discrete Lagrangian on A*G, with equal steps:
///
///     solve F-(g, lambda) = mu, phi(g) = 0 for g from q,    then q' = beta(g),  mu' = F+(g, lambda).
///
/// Of a variational system the map is Poisson and keeps the momenta of all symmetries of L and phi, which is why one
/// wants it for long motions.
///
///     const Kepler kepler;
///     FixedStepIntegrator<Kepler> orbit(kepler, {{1, 0}, {0, 1}}, Pair<2>::unit(Vector<double, 2>(1, 0)),
///                                       std::make_unique<NewtonStep<Kepler>>());
///     const StepReport report = orbit.advance();
///
/// Requires a configuration that ends at the initial object (std::invalid_argument). `advance` returns the solver's
/// report; unless that is `converged`, the point stays as it was. [G] Def. 3.3 and after Def. 3.5; momenta, Theorem 4.9

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/solvers/generating/constrained_momentum.hpp>
#include <lagroid/solvers/integrators/compensated_trajectory.hpp>
#include <lagroid/solvers/integrators/cut_step.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_predictor.hpp>

#include <memory>
#include <utility>

namespace lagroid {

/// Integrates a discrete constrained Lagrangian system. A step that does not converge leaves everything as it was.
template <DiscreteSystem Sys> class FixedStepIntegrator {
 public:
  using G = typename Sys::GroupoidType;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint).
  FixedStepIntegrator(Sys system, const State<G>& initial, const ArrowOf<G>& configuration,
                      std::unique_ptr<StepSolver<Sys>> solver)
      : predictor_(std::move(system), std::move(solver)),
        start_(start_time(predictor_.system())),
        trajectory_(predictor_.system().groupoid, initial, configuration, start_) {}

  const TrajectoryPoint<Sys>& point() const { return trajectory_.point(); }
  const Sys& system() const { return predictor_.system(); }
  /// The system's own, else those of a self-adjoint discretisation.
  MethodTraits traits() const {
    if constexpr (HasTraits<Sys>) {
      return system().traits();
    } else {
      return {"equal steps", 2, true, Variational<Sys>, false};
    }
  }

  StepReport advance();
  /// Whether a step can be made in part: where it has a size.
  bool cuts() const { return has_time_step(system()); }
  /// A share of a step from a point, by the same equations (cut_step.hpp); nothing changes.
  StepReport cut(const TrajectoryPoint<Sys>& from, double share, TrajectoryPoint<Sys>& to) {
    return cut_step(predictor_, from, share * time_step(system()), to);
  }
  /// Goes on from a point of the same index and time, which no step of its own led to.
  void go_on_from(const TrajectoryPoint<Sys>& point) {
    trajectory_.go_on_from(point);
    predictor_.forget();
  }
  /// Visits the system that its steps are of, to change it; the step's size stays.
  template <class F> void for_each_system(const F& f) {
    f(predictor_.system());
    predictor_.forget();
  }
  /// Visits all that the next step goes on from.
  void serialize(NumberArchive& archive) {
    predictor_.serialize(archive);
    trajectory_.serialize(system().groupoid, archive);
  }

 private:
  StepPredictor<Sys> predictor_;
  double start_;
  CompensatedTrajectory<Sys> trajectory_;
};

template <DiscreteSystem Sys> LAGROID_FLATTEN StepReport FixedStepIntegrator<Sys>::advance() {
  StepSolution<Sys> solution;
  const StepReport report = predictor_.solve(point().state, solution);
  if (report.converged()) {
    trajectory_.join(system().groupoid, solution);
    if (has_time_step(system())) {
      const double h = time_step(system());
      trajectory_.arrive_at(start_ + double(point().index + 1) * h, h);
      set_time(predictor_.system(), point().time);
    } else {
      trajectory_.arrive(0);
    }
  }
  return report;
}

}  // namespace lagroid
