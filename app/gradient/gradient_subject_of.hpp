#pragma once
/// The subject of `lagroid gradient`, of a system whose scene has been read.
///
///     const GradientSubject subject = gradient_subject_of(module.prepare(scene, context), scene);
///
/// Errors: SceneError for an initial value that is not by equal, adaptive, prescribed or controlled steps, or has
/// events but no equal steps of order two; std::invalid_argument for an event without derivatives.

#include "../scenes/simulation.hpp"
#include "../scenes/system_module.hpp"
#include "boundary/boundary_cost_of.hpp"
#include "event_gradient.hpp"
#include "gradient_subject.hpp"

#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/events/event_sensitivities.hpp>
#include <lagroid/run/expressions/varied_expression.hpp>
#include <lagroid/solvers/integrators/composition.hpp>
#include <lagroid/solvers/sensitivity/explicit/linearised_splitting.hpp>
#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/solvers/sensitivity/times/timed_sensitivities.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace differentiating {

template <class G> inline constexpr bool is_pair = false;
template <int N> inline constexpr bool is_pair<Pair<N>> = true;

inline void name_all(std::vector<GradientName>& out, const std::string& group, int count,
                     const std::vector<std::string>& labels) {
  for (int i = 0; i < count; ++i)
    out.push_back({group, int(labels.size()) == count ? labels[std::size_t(i)] : group + "." + std::to_string(i)});
}

/// Where a run begins.
template <DiscreteSystem Sys> struct Started {
  Sys system;
  State<typename Sys::GroupoidType> start;
  ArrowOf<typename Sys::GroupoidType> configuration;
};
template <DiscreteSystem Sys> Started<Sys> nudged(Started<Sys> from, const std::vector<Nudge>& nudges) {
  using G = typename Sys::GroupoidType;
  AlgebroidVector<G> v = AlgebroidVector<G>::Zero();
  nudge_parameters(from.system, nudges);
  for (const Nudge& nudge : nudges)
    if (nudge.parameter.empty())
      (nudge.index < G::dimension ? v(nudge.index) : from.start.momentum(nudge.index - G::dimension)) += nudge.by;
  if (nudges.empty()) return from;
  const G& groupoid = from.system.groupoid;
  const ArrowOf<G> displaced = groupoid.tau(from.start.object, v);
  from.start.object = groupoid.target(displaced);
  from.configuration = groupoid.compose(from.configuration, displaced);
  return from;
}

template <DiscreteSystem Sys>
std::unique_ptr<Integrator<Sys>> integrator_of(const Started<Sys>& from, const Composition& composition) {
  if constexpr (StepDependent<Sys>)
    if (composition.stages() > 1)
      return std::make_unique<lagroid::detail::IntegratorOf<Sys, CompositionIntegrator<Sys>>>(
          from.system, from.start, from.configuration, composition, [] { return std::make_unique<NewtonStep<Sys>>(); });
  SensitivityOptions<Sys> options;
  options.configuration = from.configuration;
  return lagroid::detail::newton_integrator(from.system, from.start, options);
}

/// By compositions of the system's flows.
template <DiscreteSystem Sys, class Observe>
std::unique_ptr<LinearisedMotion> split_motion(const Started<Sys>& from, const Composition& composition,
                                               const std::vector<std::string>& parameters, const Observe& observe) {
  if constexpr (SplitSystem<Sys>) {
    return std::make_unique<LinearisedSplitting<Sys>>(from.system, from.start, from.configuration, composition,
                                                      parameters, observe);
  } else {
    return nullptr;  // no scene of this system has such steps
  }
}

/// By steps that vary, observed with the time after object and momentum.
template <TimeMode mode, DiscreteSystem Sys, class Observe>
std::unique_ptr<LinearisedMotion> timed_motion(const Started<Sys>& from, const std::vector<std::string>& parameters,
                                               const Observe& observe) {
  if constexpr (TimedDerivatives<Sys, mode>) {
    const auto with_time = [observe](const ObservedTimedNode<Sys>& node) {
      constexpr int first = Sys::GroupoidType::object_coordinate_count() + Sys::dimension;
      const VariedVector seen = observe(node);
      VariedVector all(seen.size() + 1);
      all << seen.head(first), node.time, seen.tail(seen.size() - first);
      return all;
    };
    return std::make_unique<TimedMotion<Sys, mode>>(from.system, from.start, from.configuration, parameters, with_time);
  } else {
    return nullptr;  // no scene of this system has such steps
  }
}

/// The events of a scene, of the time and of what is observed. Throws std::invalid_argument for one that has no
/// derivative.
template <DiscreteSystem Sys, class Observe>
std::vector<SmoothEvent<Sys>> smooth_events(const std::vector<Event>& events, const std::vector<GradientName>& observed,
                                            const Observe& observe) {
  using Node = EventNode<Sys>;
  std::vector<SmoothEvent<Sys>> out;
  for (const Event& event : events) {
    auto expressions = std::make_shared<EventExpressions>(event, observed, Sys::dimension);
    const auto numbers = [observe](const Node& node) {
      const VariedVector seen = observe(node);
      VariedVector all(seen.size() + 1);
      all << node.time, seen;
      return all;
    };
    SmoothEvent<Sys> smooth{event.name,
                            [expressions, numbers](const Node& node) { return expressions->when(numbers(node)); },
                            event.direction, event.then, event.count};
    if (!event.kick.empty())
      smooth.kick = [expressions, numbers](const Node& node) {
        const VariedVector at = numbers(node);
        VariedVector by(Sys::dimension);
        for (int i = 0; i < Sys::dimension; ++i) by(i) = expressions->kick[std::size_t(i)](at);
        return by;
      };
    for (std::size_t k = 0; k < event.set.size(); ++k)
      smooth.set.push_back({event.set[k].first, [expressions, numbers, k](const Node& node) {
                              return expressions->set[k].second(numbers(node));
                            }});
    smooth.tolerance = std::max(event.tolerance, smooth.tolerance);
    out.push_back(std::move(smooth));
  }
  return out;
}

}  // namespace differentiating

template <DiscreteSystem Sys>
GradientSubject gradient_subject_of(const PreparedScene<Sys>& prepared, const Section& scene) {
  using G = typename Sys::GroupoidType;
  using differentiating::name_all;
  if (!prepared.begin) return cost_subject_of(prepared, scene);
  if (!prepared.stated)
    scene.fail("time",
               "gradient takes equal steps, perhaps composed, and adaptive, prescribed or controlled ones, solved by "
               "Newton to round-off, and splittings; leave out other modes and methods, without_root, [solver] and "
               "reduce");
  Sys system = prepared.system;
  const StatedInitialValue<Sys>& value = *prepared.stated;
  const TimeMode mode = value.choice.options.mode;
  const Composition& composition = value.choice.options.composition;
  const bool split = by_splitting(value.choice);
  if (mode == TimeMode::controlled && !TimedDerivatives<Sys, TimeMode::controlled>)
    scene.fail("time",
               "the time scale by which steps of this system are controlled has no derivatives; take "
               "mode = \"adaptive\" or equal steps");
  constexpr int n = G::dimension;
  GradientSubject out;
  if (value.choice.accuracy > 0) {
    RunResult found;
    if (!find_first_step(system, value.initial, value.choice, found)) scene.fail("time", found.message);
    for (const std::string& note : found.notes) out.notes.push_back(note + ", which derivatives hold");
  }
  out.system = value.presentation.name;
  out.steps = value.extent.steps;
  // Of pairs the displacement is that of the position itself.
  constexpr bool on_pairs = differentiating::is_pair<G>;
  name_all(out.observed, on_pairs ? "position" : "object", G::object_coordinate_count(), value.presentation.position);
  name_all(out.observed, "momentum", n, value.presentation.momentum);
  if (mode != TimeMode::fixed) out.observed.push_back({"time", "t"});
  // On pairs it is where the motion began and the position.
  if (!on_pairs) name_all(out.observed, "configuration", G::arrow_coordinate_count(), {});
  name_all(out.start, on_pairs ? "position" : "displacement", n,
           on_pairs ? value.presentation.position : std::vector<std::string>());
  name_all(out.start, "momentum", n, value.presentation.momentum);
  for (int i = 0; i < n; ++i) {
    double size = 1;
    if constexpr (on_pairs) size = value.initial.object(i);
    out.sizes.push_back(size);
  }
  for (int i = 0; i < n; ++i) out.sizes.push_back(value.initial.momentum(i));
  name_parameters(system, out);
  const auto started = [system, initial = value.initial,
                        configuration = value.configuration](const std::vector<Nudge>& nudges) {
    return differentiating::nudged(differentiating::Started<Sys>{system, initial, configuration}, nudges);
  };
  const auto observe = [](const auto& node) {
    const auto object = node.system.groupoid.coordinates_of_object(node.object);
    const auto arrow = node.system.groupoid.coordinates_of_arrow(node.configuration);
    VariedVector all_of_it(object.size() + n + arrow.size());
    all_of_it << object, node.momentum, arrow;
    return all_of_it;
  };
  out.begin = [started, observe, mode, split, composition](
                  const std::vector<std::string>& parameters,
                  const std::vector<Nudge>& nudges) -> std::unique_ptr<LinearisedMotion> {
    const auto from = started(nudges);
    if (split) return differentiating::split_motion(from, composition, parameters, observe);
    if (mode == TimeMode::adaptive) return differentiating::timed_motion<TimeMode::adaptive>(from, parameters, observe);
    if (mode == TimeMode::prescribed)
      return differentiating::timed_motion<TimeMode::prescribed>(from, parameters, observe);
    if (mode == TimeMode::controlled)
      return differentiating::timed_motion<TimeMode::controlled>(from, parameters, observe);
    return std::make_unique<LinearisedMotionOf<Sys>>(from.system, differentiating::integrator_of(from, composition),
                                                     parameters, observe);
  };
  find_refused(out);
  if (!value.extent.events.empty()) {
    if (mode != TimeMode::fixed || split || composition.stages() > 1)
      scene.fail(
          "event",
          "gradient goes through events by equal steps of order two; leave out mode, method, order and composition, or "
          "them");
    if constexpr (StepDependent<Sys> || TimeDependent<Sys>) {
      require_events(value.extent.events, *prepared.begin());
      const auto events = differentiating::smooth_events<Sys>(value.extent.events, out.observed, observe);
      for (const SmoothEvent<Sys>& event : events) out.events.push_back(event.name);
      out.through_events = [started, observe, events, steps = out.steps](const std::vector<std::string>& parameters,
                                                                         const std::vector<Nudge>& nudges, long node,
                                                                         ThroughEvents) {
        const auto from = started(nudges);
        SensitivityOptions<Sys> options{.steps = steps, .parameters = parameters, .configuration = from.configuration};
        options.observed.node = node;
        return event_sensitivities<Sys>(from.system, from.start, events, options, observe);
      };
    } else {
      scene.fail("event", fmt::format("{} has a Lagrangian that does not take its step, so that parts of steps have no "
                                      "derivatives; leave the events out",
                                      out.system));
    }
  }
  return out;
}

}  // namespace lagroid::app
