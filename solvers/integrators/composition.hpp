#pragma once
/// Steps of order four, six and eight, composed of steps of different length:
///
///     Psi_h = Phi_{gamma_s h} o ... o Phi_{gamma_1 h}.
///
/// For accurate motions they are cheaper than small steps of order two, and they keep what Phi keeps.
///
///     const Kepler kepler;
///     CompositionIntegrator<Kepler> orbit(
///         kepler, {{1, 0}, {0, 1}}, Pair<2>::unit(Vector<double, 2>(1, 0)), compositions::suzuki,
///         [&] { return make_step_solver(kepler, StepMethod::newton); });
///     const StepReport report = orbit.advance();
///
/// Requires a variational system with a step `h` whose discretisation is self-adjoint, or the parts of `symmetrised`;
/// its steps must be solvable backwards, for some gamma are negative. The configuration must end at the initial object
/// (std::invalid_argument). A step of which one stage fails leaves everything as it was; the report is that stage's.
/// Coefficients and sources are those of compositions.hpp.

#include <lagroid/core/capabilities/adjoint.hpp>
#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/solvers/integrators/compensated_trajectory.hpp>
#include <lagroid/solvers/integrators/composed_step.hpp>
#include <lagroid/solvers/integrators/compositions.hpp>
#include <lagroid/solvers/integrators/cut_step.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_predictor.hpp>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// The parts of a step: Psi_h = Phi_{gamma_s h} o ... o Phi_{gamma_1 h}, each over its share of h.
template <DiscreteSystem Sys> std::vector<Sys> composed(const Sys& system, const Composition& composition) {
  std::vector<Sys> parts(std::size_t(composition.stages()), system);
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].h = composition.coefficients[i] * system.h;
  return parts;
}

/// The same with the symmetric step Phi_{h/2} o Phi*_{h/2} of a discretisation of order one.
template <StepDependent Sys>
std::vector<WithAdjoint<Sys>> symmetrised(const Sys& system, const Composition& composition) {
  std::vector<WithAdjoint<Sys>> parts;
  for (const double fraction : composition.coefficients)
    for (const bool adjoint : {true, false}) {
      WithAdjoint<Sys> part(system);
      part.h = 0.5 * fraction * system.h;
      part.adjoint = adjoint;
      parts.push_back(part);
    }
  return parts;
}

/// Psi_h = Phi_{gamma_s h} o ... o Phi_{gamma_1 h}, Phi the step of a discrete Lagrangian system whose discretisation
/// is self-adjoint (see StepDependent), or made so by `symmetrised`. Psi conserves the momenta that Phi conserves, and
/// is Poisson. With object constraints the state at the end of a step is to be projected (`tangent_momentum`): what a
/// momentum has across C^{-1}(0) the next multiplier takes up.
///
/// Stages remember their own predecessors: each is continued from the same stage of earlier steps. A step one of whose
/// stages does not converge leaves everything as it was.
template <DiscreteSystem Sys> class CompositionIntegrator {
 public:
  using G = typename Sys::GroupoidType;
  using MakeSolver = std::function<std::unique_ptr<StepSolver<Sys>>()>;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint).
  CompositionIntegrator(const Sys& system, const State<G>& initial, const ArrowOf<G>& configuration,
                        const Composition& composition, const MakeSolver& make_solver)
      : CompositionIntegrator(composed(system, composition), initial, configuration, composition, make_solver) {}
  /// From the parts of a step, all made from one system.
  CompositionIntegrator(const std::vector<Sys>& parts, const State<G>& initial, const ArrowOf<G>& configuration,
                        const Composition& composition, const MakeSolver& make_solver)
      : start_(start_time(parts.front())),
        composition_(composition),
        trajectory_(parts.front().groupoid, initial, configuration, start_) {
    for (const Sys& part : parts) {
      h_ += part.h;
      stages_.push_back({StepPredictor<Sys>(part, make_solver()), trajectory_.point().step});
    }
  }

  const TrajectoryPoint<Sys>& point() const { return trajectory_.point(); }
  MethodTraits traits() const { return {std::string(composition_.name), composition_.order, true, true, false}; }

  /// The arrows of the last step but the last of them, each with its start and its size.
  template <class Visit> void for_each_inner_stage(const Visit& visit) const {
    double start = point().time - h_;
    for (std::size_t i = 0; i + 1 < stages_.size(); ++i) {
      const double size = stages_[i].predictor.system().h;
      visit(stages_[i].last, start, size);
      start += size;
    }
  }

  StepReport advance();
  /// A share of a step from a point, of the same stages, each cut by it (cut_step.hpp); nothing changes. The arrows
  /// before the last are visited, if there is a `visit`.
  StepReport cut(const TrajectoryPoint<Sys>& from, double share, TrajectoryPoint<Sys>& to,
                 const std::function<void(const Step<Sys>&, double start, double size)>& visit = {}) {
    TrajectoryPoint<Sys> at = from;
    const auto cut = [&](Stage& stage) {
      if (visit && &stage != &stages_.front()) visit(at.step, at.time - at.step_size, at.step_size);
      return cut_step(stage.predictor, at, share * stage.predictor.system().h, at);
    };
    const StepReport report = step_by_stages(stages_, cut, [] {});
    if (!report.converged()) return report;
    to = at;
    to.index = from.index + 1;
    to.time = from.time + share * h_;
    return report;
  }
  /// Goes on from a point of the same index and time, which no step of its own led to.
  void go_on_from(const TrajectoryPoint<Sys>& point) {
    trajectory_.go_on_from(point);
    for (Stage& stage : stages_) stage.predictor.forget();
  }
  /// Visits the systems that its stages are of, to change them; the stages' sizes stay.
  template <class F> void for_each_system(const F& f) {
    for (Stage& stage : stages_) {
      f(stage.predictor.system());
      stage.predictor.forget();
    }
  }
  /// Visits all that the next step goes on from.
  void serialize(NumberArchive& archive) {
    for (Stage& stage : stages_) {
      stage.predictor.serialize(archive);
      archive.arrow(stage.predictor.system().groupoid, stage.last.arrow);
      archive(stage.last.multipliers);
    }
    trajectory_.serialize(stages_.front().predictor.system().groupoid, archive);
  }

 private:
  struct Stage {
    StepPredictor<Sys> predictor;
    Step<Sys> last;
  };

  double h_ = 0;
  double start_;
  Composition composition_;
  std::vector<Stage> stages_;
  CompensatedTrajectory<Sys> trajectory_;
};

template <DiscreteSystem Sys> StepReport CompositionIntegrator<Sys>::advance() {
  const CompensatedTrajectory<Sys> before = trajectory_;
  double time = point().time;
  const auto solve = [&](Stage& stage) {
    StepSolution<Sys> solution;
    set_time(stage.predictor.system(), time);
    const StepReport report = stage.predictor.solve(point().state, solution);
    if (!report.converged()) return report;
    trajectory_.join(stage.predictor.system().groupoid, solution);
    stage.last = solution.step;
    time += stage.predictor.system().h;
    return report;
  };
  const auto restore = [&] {
    trajectory_ = before;
    for (auto& stage : stages_) stage.predictor.forget();
  };
  const StepReport report = step_by_stages(stages_, solve, restore);
  if (report.converged())
    trajectory_.arrive_at(start_ + double(point().index + 1) * h_, stages_.back().predictor.system().h);
  return report;
}

}  // namespace lagroid
