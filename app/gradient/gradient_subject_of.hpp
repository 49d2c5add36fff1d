#pragma once
/// The subject of `lagroid gradient`, of a system whose scene has been read.
///
///     const GradientSubject subject = gradient_subject_of(module.prepare(scene, context), scene);
///
/// Errors: SceneError for a scene that is no initial value by equal steps, or of composed ones with events;
/// std::invalid_argument for an event without derivatives.

#include "../scenes/simulation.hpp"
#include "../scenes/system_module.hpp"
#include "event_gradient.hpp"
#include "gradient_subject.hpp"

#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/events/event_sensitivities.hpp>
#include <lagroid/run/expressions/varied_expression.hpp>
#include <lagroid/solvers/integrators/composition.hpp>
#include <lagroid/solvers/sensitivity/sensitivities.hpp>

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
  for (const Nudge& nudge : nudges) {
    if (!nudge.parameter.empty()) {
      const ParameterPlaces of = places_of_parameters(from.system, {nudge.parameter});
      const_cast<double&>(*of.members.front()) += nudge.by;  // of `from`, which is no constant
    } else {
      (nudge.index < G::dimension ? v(nudge.index) : from.start.momentum(nudge.index - G::dimension)) += nudge.by;
    }
  }
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
  if (!prepared.begin)
    scene.fail("boundary", "gradient takes initial values: how a stationary path depends on its ends is no run");
  if (!prepared.by_newton)
    scene.fail("time",
               "gradient takes equal steps, perhaps composed, solved by Newton to round-off; leave out mode, "
               "method, [solver] and reduce");
  const Sys system = prepared.system;
  const NewtonInitialValue<Sys>& value = *prepared.by_newton;
  constexpr int n = G::dimension;
  GradientSubject out;
  out.system = value.presentation.name;
  out.steps = value.extent.steps;
  // Of pairs the displacement is that of the position itself.
  constexpr bool on_pairs = differentiating::is_pair<G>;
  name_all(out.observed, on_pairs ? "position" : "object", G::object_coordinate_count(),
           on_pairs ? value.presentation.position : std::vector<std::string>());
  name_all(out.observed, "momentum", n, value.presentation.momentum);
  // On pairs it is where the motion began and the position.
  if (!on_pairs) name_all(out.observed, "configuration", G::arrow_coordinate_count(), {});
  name_all(out.start, on_pairs ? "position" : "displacement", n,
           on_pairs ? value.presentation.position : std::vector<std::string>());
  name_all(out.start, "momentum", n, value.presentation.momentum);
  const ParameterPlaces all = all_parameters(system);
  for (const std::string& name : all.names) out.parameters.push_back({"parameters", name});
  for (int i = 0; i < n; ++i) {
    double size = 1;
    if constexpr (on_pairs) size = value.initial.object(i);
    out.sizes.push_back(size);
  }
  for (int i = 0; i < n; ++i) out.sizes.push_back(value.initial.momentum(i));
  for (const double* member : all.members) out.sizes.push_back(*member);
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
  out.begin = [started, observe, composition = value.composition](
                  const std::vector<std::string>& parameters,
                  const std::vector<Nudge>& nudges) -> std::unique_ptr<LinearisedMotion> {
    const auto from = started(nudges);
    return std::make_unique<LinearisedMotionOf<Sys>>(from.system, differentiating::integrator_of(from, composition),
                                                     parameters, observe);
  };
  if (!value.extent.events.empty()) {
    if (value.composition.stages() > 1)
      scene.fail("event",
                 "gradient goes through events by steps of order two; leave out order and composition, or them");
    if constexpr (StepDependent<Sys> || TimeDependent<Sys>) {
      require_events(value.extent.events, *prepared.begin());
      const auto events = differentiating::smooth_events<Sys>(value.extent.events, out.observed, observe);
      for (const SmoothEvent<Sys>& event : events) out.events.push_back(event.name);
      out.through_events = [started, observe, events, steps = out.steps](const std::vector<std::string>& parameters,
                                                                         const std::vector<Nudge>& nudges, long node) {
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
