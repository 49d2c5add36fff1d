#pragma once
/// The subject of `lagroid gradient`, of a system whose scene has been read.
///
///     const GradientSubject subject = gradient_subject_of(module.prepare(scene, context), scene);
///
/// Errors: SceneError for an initial value by steps without derivatives (motion_of_steps.hpp), or with events but no
/// equal steps that can be cut; std::invalid_argument for an event without derivatives.

#include "../scenes/simulation.hpp"
#include "../scenes/system_module.hpp"
#include "boundary/boundary_cost_of.hpp"
#include "columns/observed_columns.hpp"
#include "event_gradient.hpp"
#include "gradient_subject.hpp"
#include "motion_of_steps.hpp"
#include "velocity_start.hpp"

#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/events/derivatives/cuttable_variational.hpp>
#include <lagroid/run/motion/parameter_values.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace differentiating {

template <DiscreteSystem Sys> Started<Sys> nudged(Started<Sys> from, const std::vector<Nudge>& nudges) {
  using G = typename Sys::GroupoidType;
  if (nudges.empty()) return from;
  AlgebroidVector<G> v = AlgebroidVector<G>::Zero();
  auto given = given_beside_place(from.system, from.start);
  nudge_parameters(from.system, nudges);
  for (const Nudge& nudge : nudges)
    if (nudge.parameter.empty())
      (nudge.index < G::dimension ? v(nudge.index) : given(nudge.index - G::dimension)) += nudge.by;
  const G& groupoid = from.system.groupoid;
  const ArrowOf<G> displaced = groupoid.tau(from.start.object, v);
  from.start.object = groupoid.target(displaced);
  from.configuration = groupoid.compose(from.configuration, displaced);
  from.start.momentum = momentum_of_given(from.system, from.start.object, given);
  return from;
}

/// Why no scene starts so; empty where one does.
template <DiscreteSystem Sys> std::string refusal_of_start(Started<Sys> from) {
  std::string why = set_parameters(from.system, parameter_values(from.system));
  if constexpr (Sys::object_constraints > 0) {
    const auto& q = from.start.object;
    const double off = from.system.object_constraint(q).cwiseAbs().maxCoeff();
    // As where scenes are read (system_scene.hpp).
    if (why.empty() && !(off <= 1e-8 * (1 + from.system.groupoid.coordinates_of_object(q).squaredNorm())))
      why = fmt::format("the start is off the constraint C(q) = 0 by {:.3g}", off);
  }
  return why;
}

/// Refuses also parameters with any other value of which the run could not be reduced.
inline void find_refused_reduced(GradientSubject& subject) {
  find_refused(subject, [&](const std::vector<std::string>& parameters) {
    for (std::size_t i = 0; i < subject.parameters.size(); ++i) {
      const std::string& name = subject.parameters[i].name;
      if (std::find(parameters.begin(), parameters.end(), name) == parameters.end()) continue;
      const double value = subject.sizes[subject.start.size() + i];
      try {
        subject.begin({}, {{0, name, 1e-3 * (value == 0 ? 1 : value)}});
      } catch (const std::invalid_argument& broken) {
        throw WithoutDerivative(fmt::format("with another value, {}; leave out reduce", broken.what()));
      }
    }
    const auto motion = subject.begin(parameters, {});
    if (motion->advance().converged()) motion->linearise();
  });
}

}  // namespace differentiating

template <DiscreteSystem Sys>
GradientSubject gradient_subject_of(const PreparedScene<Sys>& prepared, const Section& scene) {
  using G = typename Sys::GroupoidType;
  using differentiating::name_all;
  if (!prepared.begin) return cost_subject_of(prepared, scene);
  if (!prepared.stated)
    scene.fail("time", "steps of this system's own method have no derivatives; leave out time.method");
  Sys system = prepared.system;
  const StatedInitialValue<Sys>& value = *prepared.stated;
  require_derivatives_of_steps(value, scene);
  constexpr int n = G::dimension;
  GradientSubject out;
  if (value.choice.accuracy > 0) {
    RunResult found;
    if (!find_first_step(system, value.initial, value.choice, found)) scene.fail("time", found.message);
    for (const std::string& note : found.notes) out.notes.push_back(note + ", which derivatives hold");
  }
  if (value.choice.options.fixed == StepKind::extrapolation) {
    out.notes.push_back("derivatives hold the inner steps that the tolerance asked for between nodes");
    out.tolerance = value.choice.options.tolerance;
  }
  if (value.choice.options.mode == TimeMode::adaptive && value.choice.options.without_root == WithoutRoot::constant)
    out.notes.push_back("derivatives hold which steps have the size of the first, for want of a root");
  out.system = value.presentation.name;
  out.steps = value.extent.steps;
  const differentiating::ObservedColumns<Sys> observe(value, system);
  out.observed = observe.names(value.choice.options.mode != TimeMode::fixed);
  out.unobserved = observe.without();
  // Of pairs the displacement is that of the position itself.
  constexpr bool on_pairs = differentiating::is_pair<G>;
  name_all(out.start, on_pairs ? "position" : "displacement", n,
           on_pairs ? value.presentation.position : std::vector<std::string>());
  static_assert(velocity_start_fits<Sys>,
                "velocity_names is there but velocities(z) or momentum_of(q, v) does not fit (see StartsByVelocity)");
  const auto given = given_beside_place(system, value.initial);
  if constexpr (StartsByVelocity<Sys>) {
    for (const std::string_view name : Sys::velocity_names) out.start.push_back({"velocity", std::string(name)});
  } else {
    name_all(out.start, "momentum", n, value.presentation.momentum);
  }
  for (int i = 0; i < n; ++i) {
    double size = 1;
    if constexpr (on_pairs) size = value.initial.object(i);
    out.sizes.push_back(size);
  }
  out.sizes.insert(out.sizes.end(), given.begin(), given.end());
  name_parameters(system, out);
  const auto started = [system, initial = value.initial,
                        configuration = value.configuration](const std::vector<Nudge>& nudges) {
    return differentiating::nudged(Started<Sys>{system, initial, configuration}, nudges);
  };
  out.begin = [started, observe, stated = prepared.stated](const std::vector<std::string>& parameters,
                                                           const std::vector<Nudge>& nudges) {
    return motion_of_steps(*stated, started(nudges), parameters, observe);
  };
  if constexpr (StartsByVelocity<Sys>)
    out.begun_by = [started](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
      const auto from = started(nudges);
      return slope_of_start(from.system, from.start, parameters);
    };
  out.refusal = [started, stated = prepared.stated](const std::vector<Nudge>& nudges) {
    const Started<Sys> from = started(nudges);
    const std::string why = differentiating::refusal_of_start(from);
    return why.empty() ? refusal_of_steps(*stated, from) : why;
  };
  if (value.reduced)
    differentiating::find_refused_reduced(out);
  else
    find_refused(out);
  if (value.extent.events.empty()) return out;
  require_events(value.extent.events, *prepared.begin());
  const std::vector<ObservedEvent> events =
      observed_events(value.extent.events, out.observed, n, /*sets=*/by_variational_steps(value));
  BeginCuttable in_parts;
  if (by_explicit_steps_in_parts(value)) {
    in_parts = [begin = out.begin](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
      return std::unique_ptr<CuttableMotion>(&dynamic_cast<CuttableMotion&>(*begin(parameters, nudges).release()));
    };
  } else if (!by_variational_steps(value)) {
    scene.fail("event",
               "gradient goes through events by equal variational steps, splittings and runge-kutta; leave out mode or "
               "method, or them");
  } else if constexpr (StepDependent<Sys> || TimeDependent<Sys>) {
    in_parts = [started, observe, set = numbers_set(events), stated = prepared.stated](
                   const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
      const auto from = started(nudges);
      return std::make_unique<CuttableVariational<Sys>>(from.system, variational_integrator(*stated, from), parameters,
                                                        set, observe);
    };
  } else {
    scene.fail("event", fmt::format("{} has a Lagrangian that does not take its step, so that parts of steps have no "
                                    "derivatives; leave the events out",
                                    out.system));
  }
  go_through_events(in_parts, events, out);
  return out;
}

}  // namespace lagroid::app
