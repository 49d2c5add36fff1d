#pragma once
/// Explicit steps of high order: compositions of the exact flows that a system's energy splits into.

#include <lagroid/core/quantity.hpp>
#include <lagroid/core/split_system.hpp>
#include <lagroid/solvers/compositions.hpp>
#include <lagroid/solvers/method.hpp>
#include <lagroid/solvers/step_solver.hpp>

#include <string>
#include <utility>

namespace lagroid {

/// A point of A*G on its way along the flows of a system, over any scalar: the arrow it has gone since `start`, and the
/// momentum, summed with compensation.
template <SplitSystem Sys, class S> class SplitMotion {
 public:
  using G = typename Sys::GroupoidType;
  using Object = typename G::template Object<S>;
  using Momentum = Vector<S, G::dimension>;

  /// Refers to the system. `carry` is what earlier sums of the momentum could not store.
  SplitMotion(const Sys& system, const Object& object, const Momentum& momentum, const Momentum& carry = zero())
      : system_(system), object_(object), momentum_(momentum), carry_(carry), arrow_(system.groupoid.unit(object)) {}

  /// For every coefficient gamma of the composition a Strang step of length t = gamma h: half of flow 0, of flow 1,
  /// ..., all of the last one, and the halves in reverse (Strang 1968). Where two steps meet the halves of flow 0 join.
  void step(const Composition& composition, double h) {
    double begun = 0;
    for (const double gamma : composition.coefficients) {
      const double t = gamma * h;
      follow<0>(begun + 0.5 * t);
      inner<1>(t);
      begun = 0.5 * t;
    }
    follow<0>(begun);
  }

  template <int I> void follow(double t) {
    const auto flow = system_.template flow<I>(t, object_, momentum_);
    arrow_ = system_.groupoid.compose(arrow_, flow.arrow);
    object_ = system_.groupoid.target(flow.arrow);
    carry_ += flow.momentum_change;
    const Momentum momentum = momentum_ + carry_;
    carry_ -= momentum - momentum_;
    momentum_ = momentum;
    remainder_ += flow.remainder;
  }

  const Object& object() const { return object_; }
  const Momentum& momentum() const { return momentum_; }
  const Momentum& carry() const { return carry_; }
  const typename G::template Arrow<S>& arrow() const { return arrow_; }
  const Momentum& remainder() const { return remainder_; }

 private:
  static Momentum zero() { return Momentum::Constant(S(0.0)); }

  template <int I> void inner(double t) {
    if constexpr (I + 1 < Sys::parts) {
      follow<I>(0.5 * t);
      inner<I + 1>(t);
      follow<I>(0.5 * t);
    } else if constexpr (I < Sys::parts) {
      follow<I>(t);
    }
  }

  const Sys& system_;
  Object object_;
  Momentum momentum_;
  Momentum carry_;
  typename G::template Arrow<S> arrow_;
  Momentum remainder_ = zero();
};

/// Marches a split system by Strang steps, composed to the order of `composition`. The step is that of the system, h.
/// Symmetric, Poisson, explicit; no allocation. Objects and momenta are accumulated with compensation.
template <SplitSystem Sys> class SplittingIntegrator {
 public:
  using G = typename Sys::GroupoidType;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint).
  SplittingIntegrator(Sys system, const State<G>& initial, const ArrowOf<G>& configuration,
                      const Composition& composition = compositions::single)
      : system_(std::move(system)), composition_(composition) {
    point_.state = initial;
    point_.configuration = configuration;
    point_.step = {system_.groupoid.unit(point_.state.object), {}};
  }

  const TrajectoryPoint<Sys>& point() const { return point_; }
  const Sys& system() const { return system_; }
  MethodTraits traits() const {
    return {"Strang splitting, composition " + std::string(composition_.name), composition_.order, true, true, true};
  }

  /// `converged`, or `not_finite` (at a singularity of a flow), which leaves everything as it was.
  StepReport advance();

 private:
  Sys system_;
  Composition composition_;
  TrajectoryPoint<Sys> point_;
  AlgebroidVector<G> momentum_carry_ = AlgebroidVector<G>::Zero();
  AlgebroidVector<G> carry_ = AlgebroidVector<G>::Zero();
};

template <SplitSystem Sys> StepReport SplittingIntegrator<Sys>::advance() {
  const auto& groupoid = system_.groupoid;
  SplitMotion<Sys, double> motion(system_, point_.state.object, point_.state.momentum, momentum_carry_);
  motion.step(composition_, system_.h);
  StepReport report;
  report.status = SolveStatus::not_finite;
  if (!motion.momentum().allFinite() || !groupoid.coordinates_of_arrow(motion.arrow()).allFinite()) return report;
  report.status = SolveStatus::converged;

  point_.step.arrow = motion.arrow();
  point_.state.momentum = motion.momentum();
  momentum_carry_ = motion.carry();
  ArrowOf<G> reached = groupoid.compose(point_.configuration, motion.arrow());
  carry_ = groupoid.nudge(reached, AlgebroidVector<G>(carry_ + motion.remainder()));
  point_.configuration = groupoid.project(reached);
  point_.state.object = groupoid.target(point_.configuration);
  ++point_.index;
  point_.time = double(point_.index) * system_.h;
  point_.step_size = system_.h;
  return report;
}

}  // namespace lagroid
