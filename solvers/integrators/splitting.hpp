#pragma once
/// Explicit steps of high order: compositions of the exact flows phi_i of the parts of the energy H = H_0 + ... + H_r.
///
///     Phi_h = phi0_{h/2} o phi1_{h/2} o ... o phir_h o ... o phi1_{h/2} o phi0_{h/2}        (Strang)
///
/// No equations are solved, so that a step costs a few evaluations; it is symmetric and Poisson.
///
///     SplittingIntegrator<Kepler> orbit(Kepler{}, {{1, 0}, {0, 1}}, Pair<2>::unit(Vector<double, 2>(1, 0)),
///                                       splittings::srkn6);
///     const StepReport report = orbit.advance();
///
/// Requires a SplitSystem with a step `h`. The constructor throws std::invalid_argument for a composition that the
/// system does not admit (`splits_by`) and for a configuration that does not end at the initial object. Status:
/// `not_finite`, which leaves everything as it was.

#include <lagroid/core/capabilities/split_system.hpp>
#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/solvers/integrators/compensated_trajectory.hpp>
#include <lagroid/solvers/integrators/compositions.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <stdexcept>
#include <string>
#include <utility>

namespace lagroid {

/// Whether the energy splits into flow 0 and the last one alone.
template <SplitSystem Sys> bool is_of_two_flows(const Sys& system) {
  if constexpr (requires { system.two_flows(); }) {
    return system.two_flows();
  } else {
    return Sys::parts == 2;
  }
}

/// Whether the composition has its order for the system: one of two flows where there are two, a Nystrom scheme where
/// the system declares that [H_0, [H_0, [H_0, H_1]]] = 0.
template <SplitSystem Sys> bool splits_by(const Sys& system, const Composition& composition) {
  if (composition.kicks.empty()) return true;
  return is_of_two_flows(system) && (!composition.nystrom || NystromSystem<Sys>);
}

/// A point of A*G on its way along the flows of a system, over any scalar: the arrow it has gone since its
/// start, and by how much the momentum has changed.
template <SplitSystem Sys, class S> class SplitMotion {
 public:
  using G = typename Sys::GroupoidType;
  using Object = typename G::template Object<S>;
  using Momentum = Vector<S, G::dimension>;

  /// Refers to the system.
  SplitMotion(const Sys& system, const Object& object, const Momentum& momentum)
      : system_(system),
        two_flows_(is_of_two_flows(system)),
        object_(object),
        start_(momentum),
        arrow_(system.groupoid.unit(object)) {}

  /// The composition's step of length h: of two flows, flow 0 and the Strang step of the others, where it has kicks.
  /// Else for every coefficient gamma of the composition a Strang step of length t = gamma h: half of flow 0, half of
  /// flow 1, and so on, all of the last one, and the halves in reverse (Strang 1968). Where two steps meet the halves
  /// of flow 0 join.
  void step(const Composition& composition, double h) {
    if (!composition.kicks.empty()) {
      alternate(composition, h);
      return;
    }
    double begun = 0;
    for (const double gamma : composition.coefficients) {
      const double t = gamma * h;
      follow<0>(begun + 0.5 * t);
      follow_others(t);
      begun = 0.5 * t;
    }
    follow<0>(begun);
  }

  /// Flow I for the time t, a double or a number for each lane of S.
  template <int I, class T> void follow(const T& t) {
    const auto flow = system_.template flow<I>(t, object_, momentum());
    arrow_ = system_.groupoid.compose(arrow_, flow.arrow);
    object_ = system_.groupoid.target(flow.arrow);
    momentum_change_ += flow.momentum_change;
    remainder_ += flow.remainder;
  }

  /// A symmetric step of all flows but flow 0.
  template <class T> void follow_others(const T& t) {
    if (Sys::parts > 1 && two_flows_) {
      follow<Sys::parts - 1>(t);
    } else {
      inner<1>(t);
    }
  }
  /// Goes back to where it began, from `object`, in lanes: `choose(begun, now)` selects numbers.
  template <class Choose> void begin_again(const Object& object, const Choose& choose) {
    const G& groupoid = system_.groupoid;
    const auto chosen = [&](auto begun, const auto& now) {
      for (Eigen::Index i = 0; i < begun.size(); ++i) begun(i) = choose(begun(i), now(i));
      return begun;
    };
    const auto at = chosen(groupoid.coordinates_of_object(object), groupoid.coordinates_of_object(object_));
    const auto gone =
        chosen(groupoid.coordinates_of_arrow(groupoid.unit(object)), groupoid.coordinates_of_arrow(arrow_));
    object_ = groupoid.template object_at<S>(at);
    arrow_ = groupoid.template arrow_at<S>(gone);
    momentum_change_ = chosen(zero(), momentum_change_);
    remainder_ = chosen(zero(), remainder_);
  }

  const Object& object() const { return object_; }
  Momentum momentum() const { return start_ + momentum_change_; }
  const Momentum& momentum_change() const { return momentum_change_; }
  /// What rounding took of the arrow, g tau(remainder).
  const Momentum& remainder() const { return remainder_; }
  const typename G::template Arrow<S>& arrow() const { return arrow_; }

  bool finite() const { return momentum().allFinite() && system_.groupoid.coordinates_of_arrow(arrow_).allFinite(); }
  /// What a CompensatedTrajectory joins.
  StepSolution<Sys> solution() const requires std::same_as<S, double> {
    StepSolution<Sys> solution;
    solution.step = {arrow_, Sys::Multipliers::Zero()};
    solution.momentum_change = momentum_change_;
    solution.remainder = remainder_;
    return solution;
  }

 private:
  static Momentum zero() { return Momentum::Constant(S(0.0)); }

  void alternate(const Composition& composition, double h) {
    const auto kick = [&](std::size_t i) {
      if (composition.kicks[i] != 0) follow<0>(composition.kicks[i] * h);
    };
    kick(0);
    for (std::size_t i = 0; i < composition.coefficients.size(); ++i) {
      follow_others(composition.coefficients[i] * h);
      kick(i + 1);
    }
  }

  template <int I, class T> void inner(const T& t) {
    if constexpr (I + 1 < Sys::parts) {
      follow<I>(0.5 * t);
      inner<I + 1>(t);
      follow<I>(0.5 * t);
    } else if constexpr (I < Sys::parts) {
      follow<I>(t);
    }
  }

  const Sys& system_;
  bool two_flows_;
  Object object_;
  Momentum start_;
  Momentum momentum_change_ = zero();
  typename G::template Arrow<S> arrow_;
  Momentum remainder_ = zero();
};

/// Integrates a split system by Strang steps, composed to the order of `composition`. The step is that of the system,
/// h. Symmetric, Poisson, explicit; no allocation. Objects and momenta are accumulated with compensation.
template <SplitSystem Sys> class SplittingIntegrator {
 public:
  using G = typename Sys::GroupoidType;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint). Throws
  /// std::invalid_argument where the composition is not for this system (`splits_by`).
  SplittingIntegrator(Sys system, const State<G>& initial, const ArrowOf<G>& configuration,
                      const Composition& composition = compositions::single)
      : system_(std::move(system)),
        composition_(composition),
        start_(start_time(system_)),
        trajectory_(system_.groupoid, initial, configuration, start_) {
    if (!splits_by(system_, composition)) throw std::invalid_argument("the splitting is for other systems");
  }

  const TrajectoryPoint<Sys>& point() const { return trajectory_.point(); }
  const Sys& system() const { return system_; }
  MethodTraits traits() const {
    const std::string kind = composition_.kicks.empty() ? "Strang splitting, composition " : "splitting ";
    return {kind + std::string(composition_.name), composition_.order, true, true, true, composition_.stages()};
  }

  /// `converged`, or `not_finite` (at a singularity of a flow), which leaves everything as it was.
  StepReport advance();
  /// Goes to a point, from which the next step is a share of what it was.
  void begin_cut(const TrajectoryPoint<Sys>& from, double share) {
    system_.h *= share;
    trajectory_ = CompensatedTrajectory<Sys>(system_.groupoid, from.state, from.configuration);
  }
  /// Goes on from a point of the same index and time, which no step of its own led to.
  void go_on_from(const TrajectoryPoint<Sys>& point) { trajectory_.go_on_from(point); }
  /// Visits the system that its steps are of, to change it; the step's size stays.
  template <class F> void for_each_system(const F& f) { f(system_); }
  /// Visits all that the next step goes on from.
  void serialize(NumberArchive& archive) { trajectory_.serialize(system_.groupoid, archive); }

 private:
  Sys system_;
  Composition composition_;
  double start_;
  CompensatedTrajectory<Sys> trajectory_;
};

template <SplitSystem Sys> StepReport SplittingIntegrator<Sys>::advance() {
  SplitMotion<Sys, double> motion(system_, point().state.object, point().state.momentum);
  motion.step(composition_, system_.h);
  StepReport report;
  report.status = motion.finite() ? SolveStatus::converged : SolveStatus::not_finite;
  if (!report.converged()) return report;
  trajectory_.join(system_.groupoid, motion.solution());
  trajectory_.arrive_at(start_ + double(point().index + 1) * system_.h, system_.h);
  return report;
}

}  // namespace lagroid
