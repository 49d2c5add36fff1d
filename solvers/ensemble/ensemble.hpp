#pragma once
/// An ensemble: very many motions of one system that differ in their initial states,
///
///     (q_i, mu_i) -> (q_i', mu_i'),    i = 1, ..., M,    one in each lane of a vector register, registers on threads.
///
/// Members share instructions, so that one costs less than a run of its own, and what becomes of it depends neither on
/// the others nor on the threads.
///
///     const std::vector<State<Pair<2>>> initial(1000, {{1, 0}, {0, 1}});
///     Ensemble<Kepler> orbits(Kepler{}, initial);
///     const bool all_steps = orbits.advance_to(2000, {.threads = 0});
///
/// Requires a system whose Lagrangian can be evaluated on batches (else it does not compile), one configuration for
/// each member or none, and `every` of one at least (std::invalid_argument). A member whose step fails keeps its last
/// state and has the status of that step; the others go on.

#include <lagroid/core/quantity.hpp>
#include <lagroid/solvers/ensemble/batch_integrator.hpp>
#include <lagroid/solvers/ensemble/tasks.hpp>

#include <algorithm>
#include <functional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace lagroid {

/// How an ensemble advances.
template <DiscreteSystem Sys, int Width = widest_batch> struct EnsembleOptions {
  int threads = 1;  ///< 0: all available ones
  /// Called with every member that goes on, at every step whose number is a multiple of `every`: in order for one
  /// member, from all threads at once for several. It may write to places of that member's own.
  std::function<void(long member, const TrajectoryPoint<Sys>& point)> observe = nullptr;
  long every = 1;  ///< at least 1; std::invalid_argument otherwise
  /// Called with every batch where it is taken up and after each of its steps, from several threads for several
  /// batches: what looks at all lanes together, and may end some of them (EnsembleWatch).
  std::function<void(long batch, BatchIntegrator<Sys, Width>& members)> visit = nullptr;
  /// Called now and then; once it returns true the advance ends, and another one goes on from there.
  std::function<bool()> interrupted = nullptr;
};

/// Members of one system that differ in their initial states, integrated by `Sys`'s implicit step with momenta by
/// increments, as `FixedStepIntegrator` integrates one.
///
/// **What becomes of a member depends on nothing but its initial state and the system**: to the bit not on the other
/// members, their order or number, nor on threads, interrupts and how steps are grouped into advances; to round-off not
/// on `Width`, and of a single `FixedStepIntegrator` it differs by round-off. A member whose step can not be solved
/// fails alone, with a typed status, and keeps its last state.
///
/// A batch of members goes through all the steps of an advance, up to `round` of them, before the next is loaded: what
/// it needs stays in the first cache. Include `systems/ensembles.hpp` for the library's systems, compiled. No
/// allocation in a step, except for a member that needs another solver's help.
template <DiscreteSystem Sys, int Width = widest_batch> class Ensemble {
 public:
  using G = typename Sys::GroupoidType;
  using Options = EnsembleOptions<Sys, Width>;

  /// Configurations are the unit arrows, unless given: the arrows whose targets are the initial objects, one for every
  /// member (see TrajectoryPoint). Throws std::invalid_argument where their number is another.
  Ensemble(Sys system, std::span<const State<G>> initial, std::span<const ArrowOf<G>> configurations = {});

  const Sys& system() const { return system_; }
  long size() const { return size_; }

  /// Takes all members that have not failed to step `index`, counted from the start. False if interrupted.
  bool advance_to(long index, const Options& options = {});

  State<G> state(long member) const { return integrator(member).state(system_, lane(member)); }
  /// Step, state, configuration and time that a member has reached.
  TrajectoryPoint<Sys> point(long member) const { return point(integrator(member), system_, lane(member)); }
  /// Converged, or why the step after the member's last one could not be solved.
  SolveStatus status(long member) const { return integrator(member).status(lane(member)); }
  /// Members that have failed.
  long failures() const {
    long count = 0;
    for (long i = 0; i < size_; ++i) count += status(i) != SolveStatus::converged;
    return count;
  }

 private:
  using Integrator = BatchIntegrator<Sys, Width>;
  static constexpr long round = 256;

  static int lane(long member) { return int(member % Width); }
  const Integrator& integrator(long member) const { return integrators_[std::size_t(member / Width)]; }
  static TrajectoryPoint<Sys> point(const Integrator& integrator, const Sys& system, int lane);
  void advance(long batch, long index, const Options& options);

  Sys system_;
  long size_;
  std::vector<Integrator> integrators_;
};

template <DiscreteSystem Sys, int Width>
Ensemble<Sys, Width>::Ensemble(Sys system, std::span<const State<G>> initial,
                               std::span<const ArrowOf<G>> configurations)
    : system_(std::move(system)), size_(long(initial.size())), integrators_((initial.size() + Width - 1) / Width) {
  if (!configurations.empty() && configurations.size() != initial.size())
    throw std::invalid_argument("an ensemble takes one configuration for every member, or none");
  for (long i = 0; i < long(integrators_.size()) * Width; ++i) {
    const auto member = std::size_t(std::min(i, size_ - 1));
    const State<G>& state = initial[member];
    integrators_[std::size_t(i / Width)].start(
        system_, lane(i), state,
        configurations.empty() ? ArrowOf<G>(system_.groupoid.unit(state.object)) : configurations[member], i < size_);
  }
}

template <DiscreteSystem Sys, int Width>
TrajectoryPoint<Sys> Ensemble<Sys, Width>::point(const Integrator& integrator, const Sys& system, int lane) {
  TrajectoryPoint<Sys> out;
  out.index = integrator.index(lane);
  if constexpr (HasTimeStep<Sys>) {
    out.step_size = system.h;
    out.time = start_time(system) + double(out.index) * system.h;
  }
  out.state = integrator.state(system, lane);
  out.configuration = integrator.configuration(system, lane);
  out.step = out.index == 0 ? Step<Sys>{system.groupoid.unit(out.state.object), Sys::Multipliers::Zero()}
                            : integrator.step(system, lane);
  return out;
}

template <DiscreteSystem Sys, int Width> bool Ensemble<Sys, Width>::advance_to(long index, const Options& options) {
  if (options.every < 1) throw std::invalid_argument("an ensemble is observed at every step, or at every n-th, n > 0");
  constexpr long batches_per_task = 4;
  const long count = long(integrators_.size());
  long reached = index;
  for (const Integrator& integrator : integrators_) reached = std::min(reached, integrator.index());
  while (reached < index) {
    if (options.interrupted && options.interrupted()) return false;
    reached = std::min(index, reached + round);
    for_each_task((count + batches_per_task - 1) / batches_per_task, options.threads,
                  [&](long task) {
                    const long end = std::min(count, (task + 1) * batches_per_task);
                    for (long batch = task * batches_per_task; batch < end; ++batch) advance(batch, reached, options);
                  },
                  options.interrupted);
  }
  return std::all_of(integrators_.begin(), integrators_.end(),
                     [&](const Integrator& integrator) { return integrator.index() >= index; });
}

template <DiscreteSystem Sys, int Width>
void Ensemble<Sys, Width>::advance(long batch, long index, const Options& options) {
  Integrator& integrator = integrators_[std::size_t(batch)];
  Sys system = system_;
  if (options.visit) options.visit(batch, integrator);
  while (integrator.index() < index) {
    if constexpr (TimeDependent<Sys>) system.time = system_.time + double(integrator.index()) * system_.h;
    integrator.advance(system);
    if (options.observe && integrator.index() % options.every == 0)
      for (int lane = 0; lane < Width; ++lane)
        if (integrator.goes_on(lane)) options.observe(batch * Width + lane, point(integrator, system_, lane));
    if (options.visit) options.visit(batch, integrator);
  }
}

}  // namespace lagroid
