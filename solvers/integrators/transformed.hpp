#pragma once
/// Explicit steps that are equal in another time s and so short where an attraction is strong:
///
///     dt = ds / (-U(q)) = ds / (T(p) - E),    flows of log(T - E) - log(-U).
///
/// Close encounters are the reason: equal steps of t fail there, and on Kepler's orbits only the time is in error here.
///
///     TransformedIntegrator<Kepler> orbit(Kepler{}, {{1, 0}, {0, 0.1}}, Pair<2>::unit(Vector<double, 2>(1, 0)));
///     const StepReport report = orbit.advance();
///
/// Requires an AttractiveSystem, with U < 0. The constructor throws std::invalid_argument for a composition of two
/// flows and for a configuration that does not end at the initial object. Status: `left_domain` where U >= 0 or T <= E,
/// `not_finite`; both leave everything as it was. (Mikkola and Tanikawa 1999; Preto and Tremaine 1999.)

#include <lagroid/core/capabilities/split_system.hpp>
#include <lagroid/solvers/integrators/splitting.hpp>

#include <string>
#include <utility>

namespace lagroid {

namespace detail {

/// A step of this length of s, over any scalar; returns the time that it takes. `inside` becomes false where U is not
/// negative or T - E not positive.
template <AttractiveSystem Sys, class S>
S transformed_step(const Sys& system, const Composition& composition, const S& energy, const S& length,
                   SplitMotion<Sys, S>& motion, bool& inside) {
  S time(0.0);
  const auto kick = [&](double share) {
    const S depth = -system.potential_energy(motion.object());
    inside = inside && depth > S(0.0);
    motion.template follow<0>(S(share * length / depth));
  };
  const auto drift = [&](double share) {
    const S depth = system.kinetic_energy(motion.momentum()) - energy;
    inside = inside && depth > S(0.0);
    const S t = share * length / depth;
    motion.template follow<1>(t);
    time += t;
  };
  double begun = 0;
  for (const double gamma : composition.coefficients) {
    drift(begun + 0.5 * gamma);
    kick(gamma);
    begun = 0.5 * gamma;
  }
  drift(begun);
  return time;
}

}  // namespace detail

/// Integrates H = T + U, U < 0, by splitting the logarithmic Hamiltonian log(T - E) - log(-U), E the energy at the
/// start (Mikkola and Tanikawa, Celest. Mech. Dyn. Astron. 74 (1999) 287; Preto and Tremaine, Astron. J. 118 (1999)
/// 2532). Where H = E its motion is that of H in the time s with dt = ds / (T - E) = ds / (-U), so that equal steps of
/// s are short where the attraction is strong. Both flows are those of T and of U, over the times ds / (T - E) and ds /
/// (-U), which do not change along them. A step is half of the flow of T, the flow of U and the other half, composed.
/// On Kepler's problem its orbit is exact, and only the time on it errs; begun with half of U it is not.
///
/// Symmetric; symplectic on the phase space extended by time and E; explicit; no allocation. The first step takes about
/// the time system.h.
template <AttractiveSystem Sys> class TransformedIntegrator {
 public:
  using G = typename Sys::GroupoidType;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint). Throws
  /// std::invalid_argument for a composition of two flows.
  TransformedIntegrator(Sys system, const State<G>& initial, const ArrowOf<G>& configuration,
                        const Composition& composition = compositions::single)
      : system_(std::move(system)),
        composition_(composition),
        energy_(energy_of(initial)),
        step_(-system_.h * system_.potential_energy(initial.object)),
        trajectory_(system_.groupoid, initial, configuration) {
    if (!composition.kicks.empty()) throw std::invalid_argument("transformed time takes compositions of steps");
  }

  const TrajectoryPoint<Sys>& point() const { return trajectory_.point(); }
  MethodTraits traits() const {
    return {"splitting in transformed time, composition " + std::string(composition_.name),
            composition_.order,
            true,
            false,
            true,
            composition_.stages()};
  }

  /// `converged`; `left_domain` where U is not negative or T - E not positive, `not_finite`: both leave everything as
  /// it was.
  StepReport advance();
  /// Goes to a point, from which the next step is a share of what it was, in its own time.
  void begin_cut(const TrajectoryPoint<Sys>& from, double share) {
    step_ *= share;
    trajectory_ = CompensatedTrajectory<Sys>(system_.groupoid, from.state, from.configuration);
  }
  /// E of H = E, and of what length steps are in s.
  double energy() const { return energy_; }
  double length() const { return step_; }
  /// Steps end where they end in time.
  static constexpr bool has_own_time = true;
  /// Goes on with the motions of the energy that this state has.
  void follow_energy_of(const State<G>& state) { energy_ = energy_of(state); }
  /// Goes on from a point of that energy, which no step of its own led to.
  void go_on_from(const TrajectoryPoint<Sys>& point) { trajectory_.go_on_from(point); }
  /// Visits the system that its steps are of, to change it.
  template <class F> void for_each_system(const F& f) { f(system_); }
  /// Visits all that the next step goes on from.
  void serialize(NumberArchive& archive) {
    archive(energy_, step_);
    trajectory_.serialize(system_.groupoid, archive);
  }

 private:
  double energy_of(const State<G>& state) const {
    return system_.kinetic_energy(state.momentum) + system_.potential_energy(state.object);
  }

  Sys system_;
  Composition composition_;
  double energy_;
  double step_;  ///< of s
  CompensatedTrajectory<Sys> trajectory_;
};

template <AttractiveSystem Sys> StepReport TransformedIntegrator<Sys>::advance() {
  SplitMotion<Sys, double> motion(system_, point().state.object, point().state.momentum);
  bool inside = true;
  const double time = detail::transformed_step(system_, composition_, energy_, step_, motion, inside);
  StepReport report;
  report.status = !std::isfinite(time) || !motion.finite() ? SolveStatus::not_finite
                  : inside                                 ? SolveStatus::converged
                                                           : SolveStatus::left_domain;
  if (!report.converged()) return report;
  trajectory_.join(system_.groupoid, motion.solution());
  trajectory_.arrive(time);
  return report;
}

}  // namespace lagroid
