#pragma once
/// Exact derivatives of a run through events whose times depend on its start and its parameters: where g(t, x) = 0,
///
///     dt* = -(g_x dx + g_theta dtheta) / (g_x X_s + g_t),    dx* = X dx + X_s dt*,
///
/// X the derivative of the partial step that ends there and X_s that by its duration; after a kick k(t, x) the rest of
/// the step, which is shorter by dt*, goes on from (q*, mu* + k). A parameter that becomes another number p(t, x) there
/// depends on the start from then on, dp = p_x dx* + p_theta dtheta + p_t dt*, and no more on what it was. These are
/// the saltation matrices of the discrete motion itself: nothing is differenced, and symplectic steps stay so between
/// events.
///
///     SmoothEvent<Bob> floor{"floor", [](const auto& node) { return node.object(1); }};
///     floor.direction = Event::Direction::falling;
///     floor.then = Event::Then::stop;
///     const EventSensitivities fall = event_sensitivities(bob, start, {floor}, {.steps = 100});
///     const double time_by_height = fall.happened[0].by_start(1);
///
/// It is a run of MotionThroughEvents by CuttableVariational, of functions of nodes in place of what is observed.
///
/// Requires what `sensitivities` does, and a Lagrangian that takes its step as an argument; events at zero. Returns a
/// status: `singular` where an event grazes zero, happens at a node or together with one that changes the motion or
/// ends it, for there the derivative does not exist; that of a step that fails; `left_domain` where a function is no
/// finite number, or what is set is refused by the system. An event that only records and touches zero has not
/// happened, which is noted.
///
/// Errors: std::invalid_argument for a name that is no parameter or an event without a function; WithoutDerivative for
/// a parameter that varies, as it is asked for or set by what does, or a force's step size, that the system reads as a
/// plain number: the first step that it is in is compared with differences. Source: implicit function theorem at the
/// partial step; Hiskens and Pai, IEEE Trans. Circuits Syst. I 47, 2000, 204 (flows).

#include <lagroid/run/events/derivatives/cuttable_variational.hpp>
#include <lagroid/run/events/derivatives/event_derivatives.hpp>
#include <lagroid/run/events/derivatives/motion_through_events.hpp>
#include <lagroid/solvers/sensitivity/sensitivities.hpp>

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// What a function of an event sees: a node, or a point within a step, and the time there.
template <class Sys> using EventNode = ObservedTimedNode<Sys>;
/// What is observed of a node.
template <class Sys> using ObserveEventNode = ObserveTimedNode<Sys>;

/// An event with derivatives: where its function passes zero.
template <DiscreteSystem Sys> struct SmoothEvent {
  std::string name;
  std::function<VariedNumber(const EventNode<Sys>&)> function;
  Event::Direction direction = Event::Direction::both;
  Event::Then then = Event::Then::record;
  long count = 1;                   ///< the run stops when it has happened so often
  ObserveEventNode<Sys> kick = {};  ///< added to the momentum there
  double tolerance = 1e-8;          ///< nearer to zero, relative to the largest value so far, its function touches it
  /// A parameter that is a number, which becomes another one there.
  struct Setting {
    std::string name;
    std::function<VariedNumber(const EventNode<Sys>&)> number;
  };
  std::vector<Setting> set = {};

  bool changes_motion() const { return kick || !set.empty(); }
  /// Whether the motion depends on when it happens.
  bool decides() const { return changes_motion() || then == Event::Then::stop; }
};

namespace detail {

/// What an event looks at of a node: its function, the numbers that it sets, its kick.
template <DiscreteSystem Sys> int looked_at(const SmoothEvent<Sys>& event) {
  return 1 + int(event.set.size()) + (event.kick ? Sys::dimension : 0);
}
template <DiscreteSystem Sys>
void look_at(const SmoothEvent<Sys>& event, const EventNode<Sys>& node, Eigen::Ref<VariedVector> out) {
  int at = 0;
  out(at++) = event.function(node);
  for (const auto& each : event.set) out(at++) = each.number(node);
  if (!event.kick) return;
  const VariedVector kick = event.kick(node);
  if (kick.size() != Sys::dimension)
    throw std::invalid_argument("event \"" + event.name + "\": its kick has " + std::to_string(kick.size()) +
                                " numbers, the momentum has " + std::to_string(Sys::dimension));
  out.tail(Sys::dimension) = kick;
}
/// The same event, of what is looked at, which begins at this place.
template <DiscreteSystem Sys> ObservedEvent observed(const SmoothEvent<Sys>& event, Eigen::Index at) {
  if (!event.function) throw std::invalid_argument("event \"" + event.name + "\": it has no function");
  const auto next = [&at] { return [i = at++](const VariedVector& seen) { return seen(i); }; };
  ObservedEvent out{.name = event.name,
                    .function = next(),
                    .direction = event.direction,
                    .then = event.then,
                    .count = event.count,
                    .tolerance = event.tolerance};
  for (const auto& each : event.set) out.set.push_back({each.name, next()});
  if (event.kick) out.kick = [at](const VariedVector& seen) { return VariedVector(seen.segment(at, Sys::dimension)); };
  return out;
}

}  // namespace detail

/// By equal variational steps, perhaps composed, from the start until the last step or the event that stops the run.
/// `observe`, if any, is looked at where events happen and at the end, or at the node that options.observed asks for.
/// The integrator is at its start and makes steps, also in part, that solve the equations of the system: reduced ones
/// do, too, where nothing is changed on the way.
template <DiscreteSystem Sys>
requires StepDependent<Sys> || TimeDependent<Sys> EventSensitivities event_sensitivities(
    const Sys& system, std::unique_ptr<Integrator<Sys>> integrator, const std::vector<SmoothEvent<Sys>>& events,
    const SensitivityOptions<Sys>& options = {}, ObserveEventNode<Sys> observe = {}) {
  constexpr int n = Sys::dimension;
  if (options.observed.kind == Observed::Kind::integral)
    throw std::invalid_argument("events leave no equal steps over which to integrate: observe a node, or the end");
  std::vector<ObservedEvent> of_what_is_seen;
  std::vector<std::string> set;
  int looked_at = 0;
  for (const SmoothEvent<Sys>& event : events) {
    of_what_is_seen.push_back(detail::observed(event, 1 + looked_at));  // behind the time
    looked_at += detail::looked_at(event);
    for (const auto& each : event.set) set.push_back(each.name);
  }
  // What events look at, what is observed, and the momentum that is reported.
  const auto look = [events, observe, looked_at](const EventNode<Sys>& node) {
    const VariedVector seen = observe ? observe(node) : VariedVector();
    VariedVector all(looked_at + seen.size() + n);
    int at = 0;
    for (const SmoothEvent<Sys>& event : events) {
      detail::look_at<Sys>(event, node, all.segment(at, detail::looked_at(event)));
      at += detail::looked_at(event);
    }
    all.segment(looked_at, seen.size()) = seen;
    all.tail(n) = node.momentum;
    return all;
  };
  auto cuttable =
      std::make_unique<CuttableVariational<Sys>>(system, std::move(integrator), options.parameters, set, look);
  std::vector<std::string> asked = places_of_parameters(system, options.parameters).names;
  MotionThroughEvents motion(std::move(cuttable), std::move(of_what_is_seen));
  const int numbers = int(asked.size());
  const Eigen::MatrixXd directions = Eigen::MatrixXd::Identity(2 * n + motion.parameters(), 2 * n + numbers);
  const std::vector<double> begun = motion.save();
  EventSensitivities out = motion.run(options.steps, directions, -1, numbers);
  out.parameters = std::move(asked);
  if (out.observed.size() > 0) {
    out.by_start.bottomRows(n) = out.observed_by_start.bottomRows(n);
    out.by_parameters.bottomRows(n) = out.observed_by_parameters.bottomRows(n);
  }
  if (out.converged() && options.observed.node >= 0) {
    motion.restore(begun);
    const EventSensitivities there = motion.run(options.steps, directions, options.observed.node, numbers);
    out.observed = there.observed;
    out.observed_by_start = there.observed_by_start;
    out.observed_by_parameters = there.observed_by_parameters;
  }
  const auto keep_observed = [&](auto& place) {
    if (place.observed.size() == 0) return;
    const Eigen::Index size = place.observed.size() - looked_at - n;
    place.observed = Eigen::VectorXd(place.observed.segment(looked_at, size));
    place.observed_by_start = Eigen::MatrixXd(place.observed_by_start.middleRows(looked_at, size));
    place.observed_by_parameters = Eigen::MatrixXd(place.observed_by_parameters.middleRows(looked_at, size));
  };
  keep_observed(out);
  for (auto& each : out.happened) keep_observed(each);
  return out;
}
template <DiscreteSystem Sys>
requires StepDependent<Sys> || TimeDependent<Sys> EventSensitivities event_sensitivities(
    const Sys& system, const State<typename Sys::GroupoidType>& start, const std::vector<SmoothEvent<Sys>>& events,
    const SensitivityOptions<Sys>& options = {}, ObserveEventNode<Sys> observe = {}) {
  return event_sensitivities<Sys>(system, detail::newton_integrator(system, start, options), events, options,
                                  std::move(observe));
}

}  // namespace lagroid
