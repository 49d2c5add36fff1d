#pragma once
/// Events of the members of an ensemble: where g(t, z_i(t)) = 0 for member i, in all lanes of a register at once,
///
///     (g_k < 0) != (g_{k+1} < 0) as a mask; then the partial step of each member in it, g(Phi_{theta h}(z_k)) = 0.
///
/// First passages, sections and periods of very many motions cost little more than the motions themselves: a step in
/// which nothing happens takes one evaluation of g for all lanes and two comparisons.
///
///     const EnsembleEvent<Pendulum> bottom("bottom", [](const auto& node) { return node.state.object(0); });
///     const std::vector<State<Pair<1>>> initial(1000, {Vector<double, 1>(0.5), Vector<double, 1>(0.0)});
///     Ensemble<Pendulum> pendulums(Pendulum{}, initial);
///     EnsembleWatch<Pendulum> watch(Pendulum{}, {bottom}, pendulums.size());
///     pendulums.advance_to(2000, {.visit = watch.visitor()});
///     for (const EnsembleHappening<Pendulum>& each : watch.happened()) std::cout << each.time << '\n';
///
/// Requires a system with a time step, whose g is a template on the scalar without branches on its values; the watch
/// outlives the advance, and finds what happens from the first node on at which it is given. Two zeros in one step
/// leave the sign as it is and are not seen: the watch of single runs looks for those (event_watch.hpp). A sign that
/// changes by a jump or a pole is no zero, and no event; nor is a zero of the first node. A member whose partial step
/// does not converge there has an event without a place (`converged` is false, the time is that of the node before),
/// which counts for nothing. Nothing throws but what g throws. Members' nodes have the bits that they have without.

#include <lagroid/run/events/event.hpp>
#include <lagroid/run/events/function_watch.hpp>
#include <lagroid/run/events/within_step.hpp>
#include <lagroid/solvers/ensemble/ensemble.hpp>
#include <lagroid/solvers/integrators/cut_step.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// What a function sees: one member, or those in the lanes of a register. The momentum is that of the step, not
/// projected to object constraints.
template <DiscreteSystem Sys, class S> struct EnsembleNode {
  const Sys& system;
  double time;
  const State<typename Sys::GroupoidType, S>& state;
};

/// What is watched for in every member.
template <DiscreteSystem Sys, int Width = widest_batch> struct EnsembleEvent {
  /// `function(node)` is a number for each kind of node.
  template <class F>
  EnsembleEvent(std::string called, F function)
      : name(std::move(called)), of_one(function), of_lanes(std::move(function)) {}

  std::string name;
  Event::Direction direction = Event::Direction::both;
  Event::Then then = Event::Then::record;
  long count = 1;  ///< a member goes no further than to the end of the step in which it has happened so often
  std::function<double(const EnsembleNode<Sys, double>&)> of_one;
  std::function<Batch<Width>(const EnsembleNode<Sys, Batch<Width>>&)> of_lanes;
};

/// Where one happened: the member, which event, the step, the time (s) and the state there.
template <DiscreteSystem Sys> struct EnsembleHappening {
  long member;
  std::size_t event;
  long step;
  double time;
  Passing passing;
  bool converged;
  State<typename Sys::GroupoidType> state;
};

template <DiscreteSystem Sys, int Width = widest_batch>
requires HasTimeStep<Sys>
class EnsembleWatch {
 public:
  using G = typename Sys::GroupoidType;
  using B = Batch<Width>;
  using Happenings = std::vector<EnsembleHappening<Sys>>;

  EnsembleWatch(const Sys& system, std::vector<EnsembleEvent<Sys, Width>> events, long members)
      : system_(system), events_(std::move(events)), batches_(std::size_t((members + Width - 1) / Width)) {
    for (PerBatch& each : batches_) {
      each.values.resize(events_.size());
      each.counts.resize(events_.size() * Width);
    }
  }

  /// For EnsembleOptions::visit.
  auto visitor() {
    return [this](long batch, BatchIntegrator<Sys, Width>& members) { pass(batch, members); };
  }
  /// A batch at its next node.
  void pass(long batch, BatchIntegrator<Sys, Width>& members) {
    PerBatch& known = batches_[std::size_t(batch)];
    const double time = time_at(members.index());
    for (std::size_t i = 0; i < events_.size(); ++i) {
      const B now = events_[i].of_lanes({system_, time, members.states()});
      const B before = std::exchange(known.values[i], now);
      if (!known.is_next(members.index())) continue;
      const auto rises = before < 0.0 && now >= 0.0, falls = before >= 0.0 && now < 0.0;
      if (xsimd::any(rises || falls))
        for (int lane = 0; lane < Width; ++lane) {
          const bool has_risen = rises.get(std::size_t(lane));
          if (!std::isfinite(before[lane]) || !std::isfinite(now[lane])) continue;
          if (members.goes_on(lane) && (has_risen || falls.get(std::size_t(lane))) &&
              is_in_direction(events_[i].direction, before[lane], now[lane]))
            look_into_step(batch, members, i, lane, before[lane], now[lane]);
        }
    }
    if (known.found.size() > known.settled) settle(known, members);
    if (known.first < 0) known.first = members.index();
    known.states = members.states();
    known.seen = members.index();
  }

  /// All that has happened, member by member, in the order of time.
  Happenings happened() const {
    Happenings all;
    for (const PerBatch& each : batches_) all.insert(all.end(), each.found.begin(), each.found.end());
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.member < b.member; });
    return all;
  }

 private:
  struct PerBatch {
    std::vector<B> values;  ///< of every function at the node before
    State<G, B> states;     ///< there
    std::vector<long> counts;
    Happenings found;
    std::size_t settled = 0;
    long first = -1;  ///< node that it was given
    long seen = -1;   ///< and the last one
    bool is_next(long index) const { return seen >= 0 && index == seen + 1; }
  };

  double time_at(long index) const { return start_time(system_) + double(index) * system_.h; }
  /// By partial steps of that member alone.
  [[gnu::cold, gnu::noinline]] void look_into_step(long batch, const BatchIntegrator<Sys, Width>& members,
                                                   std::size_t event, int lane, double before, double now) {
    PerBatch& known = batches_[std::size_t(batch)];
    TrajectoryPoint<Sys> from, inside;
    from.index = members.index() - 1;
    from.time = time_at(from.index);
    from.state = detail::state_of_lane<Width>(system_.groupoid, known.states, lane);
    from.configuration = system_.groupoid.unit(from.state.object);
    StepPredictor<Sys> predictor(system_, std::make_unique<NewtonStep<Sys>>());
    bool is_cut = true;
    const auto go = [&](double share) {
      if (share == 0) {
        inside = from;
      } else {
        is_cut = is_cut && cut_step(predictor, from, share * system_.h, inside).converged();
      }
    };
    const StepFunction g = [&](double share) {
      go(share);
      return is_cut ? events_[event].of_one({system_, inside.time, inside.state}) : before;
    };
    EnsembleHappening<Sys> found{batch * Width + lane,    event, members.index(), from.time,
                                 passing_of(before, now), true,  from.state};
    try {
      const RootInStep root = root_within(g, 0, 1, before, now);
      if (is_cut && (root.is_jump || (from.index == known.first && root.share <= at_the_start))) return;
      if (is_cut) go(root.share);
    } catch (const NoNumber&) {
      return;
    }
    found.converged = is_cut;
    if (is_cut) {
      found.time = inside.time;
      found.state = inside.state;
    }
    known.found.push_back(found);
  }

  /// What was found in a step, in the order of time; ends members that have had enough, where nothing follows.
  [[gnu::cold, gnu::noinline]] void settle(PerBatch& known, BatchIntegrator<Sys, Width>& members) {
    const Happenings found(known.found.begin() + std::ptrdiff_t(known.settled), known.found.end());
    known.found.resize(known.settled);
    std::array<double, std::size_t(Width)> ends;
    ends.fill(std::copysign(std::numeric_limits<double>::infinity(), system_.h));
    for (const EnsembleHappening<Sys>& each : in_time(found)) {
      const auto lane = std::size_t(each.member % Width);
      if (is_before(ends[lane], each.time)) continue;
      known.found.push_back(each);
      if (!each.converged) continue;
      const EnsembleEvent<Sys, Width>& event = events_[each.event];
      if (++known.counts[each.event * Width + lane] < event.count || event.then != Event::Then::stop) continue;
      ends[lane] = each.time;
      members.end(int(lane));
    }
    known.settled = known.found.size();
  }
  Happenings in_time(Happenings found) const {
    std::stable_sort(found.begin(), found.end(),
                     [this](const auto& a, const auto& b) { return is_before(a.time, b.time); });
    return found;
  }
  bool is_before(double a, double b) const { return system_.h > 0 ? a < b : b < a; }

  static constexpr double at_the_start = 1e-12;  ///< of a step

  Sys system_;
  std::vector<EnsembleEvent<Sys, Width>> events_;
  std::vector<PerBatch> batches_;
};

}  // namespace lagroid
