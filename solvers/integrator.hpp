#pragma once
/// The one-step map on A*G: (q, mu) -> g -> (q', mu').

#include <lagroid/core/stepped.hpp>
#include <lagroid/solvers/constrained_momentum.hpp>
#include <lagroid/solvers/method.hpp>
#include <lagroid/solvers/stepper.hpp>
#include <lagroid/solvers/walk.hpp>

#include <memory>
#include <utility>

namespace lagroid {

/// mu with the part removed that leaves C^{-1}(0) (RATTLE's second stage): mu + nu . dC o rho with nu such that
/// dC o rho W mu = 0, where W = (-d2L/dv dw)^{-1} at the unit arrow is the inverse mass matrix up to a factor.
/// For nonholonomic and forced systems see constrained_momentum; the identity for others without object constraints.
/// The dynamics is the same with and without it; the projected momentum is the one in which the map is symplectic on
/// T*C^{-1}(0).
template <DiscreteSystem Sys>
AlgebroidVector<typename Sys::GroupoidType> tangent_momentum(const Sys& system,
                                                             const State<typename Sys::GroupoidType>& state) {
  if constexpr (Nonholonomic<Sys> || (Forced<Sys> && Sys::arrow_constraints == 0 && Sys::object_constraints > 0)) {
    return constrained_momentum(system, state);
  } else if constexpr (Sys::object_constraints == 0) {
    return state.momentum;
  } else {
    constexpr int k = Sys::object_constraints;
    const auto d = two_sided(system, system.groupoid.unit(state.object), Sys::Multipliers::Zero().eval());
    const Matrix<double, Sys::dimension, k> normal = -d.constraint_source.template rightCols<k>();
    const Eigen::PartialPivLU<Matrix<double, Sys::dimension, Sys::dimension>> mass(-d.mixed);
    const Matrix<double, Sys::dimension, k> w_normal = mass.solve(normal);
    const Vector<double, k> nu =
        (normal.transpose() * w_normal).partialPivLu().solve(w_normal.transpose() * state.momentum);
    return state.momentum - normal * nu;
  }
}

/// Marches a discrete constrained Lagrangian system. A step that does not converge leaves everything as it was.
template <DiscreteSystem Sys> class Integrator {
 public:
  using G = typename Sys::GroupoidType;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint).
  Integrator(Sys system, const State<G>& initial, const ArrowOf<G>& configuration,
             std::unique_ptr<StepSolver<Sys>> solver)
      : stepper_(std::move(system), std::move(solver)),
        start_(start_time(stepper_.system())),
        walk_(stepper_.system().groupoid, initial, configuration, start_) {}

  const TrajectoryPoint<Sys>& point() const { return walk_.point(); }
  const Sys& system() const { return stepper_.system(); }
  /// Of a self-adjoint discretisation.
  static MethodTraits traits() { return {"fixed", 2, true, true, false}; }

  StepReport advance();

 private:
  Stepper<Sys> stepper_;
  double start_;
  Walk<Sys> walk_;
};

template <DiscreteSystem Sys> LAGROID_FLATTEN StepReport Integrator<Sys>::advance() {
  StepSolution<Sys> solution;
  const StepReport report = stepper_.solve(point().state, solution);
  if (report.converged()) {
    walk_.join(system().groupoid, solution);
    if constexpr (HasTimeStep<Sys>) {
      walk_.arrive_at(start_ + double(point().index + 1) * system().h, system().h);
      set_time(stepper_.system(), point().time);
    } else {
      walk_.arrive(0);
    }
  }
  return report;
}

}  // namespace lagroid
