#pragma once
/// The subject of `lagroid gradient`, of a system whose scene has been read.
///
///     const GradientSubject subject = gradient_subject_of(module.prepare(scene, context), scene);
///
/// Errors: SceneError for a scene that is no initial value by equal steps of order two.

#include "../scenes/simulation.hpp"
#include "../scenes/system_module.hpp"
#include "gradient_subject.hpp"

#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/sensitivity/sensitivities.hpp>

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

}  // namespace differentiating

template <DiscreteSystem Sys>
GradientSubject gradient_subject_of(const PreparedScene<Sys>& prepared, const Section& scene) {
  using G = typename Sys::GroupoidType;
  using differentiating::name_all;
  if (!prepared.begin)
    scene.fail("boundary", "gradient takes initial values: how a stationary path depends on its ends is no run");
  if (scene.has("event"))
    scene.fail("event", "gradient is of the whole run, step by step, without events; leave them out");
  if (!prepared.plain)
    scene.fail("time",
               "gradient takes equal steps of order two, solved by Newton to round-off; leave out mode, method, "
               "order and composition, [solver] and reduce");
  const Sys system = prepared.system;
  const NewtonInitialValue<Sys>& value = *prepared.plain;
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
  out.begin = [system, initial = value.initial, configuration = value.configuration](
                  const std::vector<std::string>& parameters,
                  const std::vector<Nudge>& nudges) -> std::unique_ptr<LinearisedMotion> {
    Sys changed = system;
    State<G> start = initial;
    AlgebroidVector<G> v = AlgebroidVector<G>::Zero();
    for (const Nudge& nudge : nudges) {
      if (!nudge.parameter.empty()) {
        const ParameterPlaces of = places_of_parameters(changed, {nudge.parameter});
        const_cast<double&>(*of.members.front()) += nudge.by;  // of `changed`, which is no constant
      } else {
        (nudge.index < n ? v(nudge.index) : start.momentum(nudge.index - n)) += nudge.by;
      }
    }
    ArrowOf<G> from = configuration;
    if (!nudges.empty()) {
      const ArrowOf<G> displaced = system.groupoid.tau(initial.object, v);
      start.object = system.groupoid.target(displaced);
      from = system.groupoid.compose(configuration, displaced);
    }
    const auto observe = [](const ObservedNode<Sys>& node) {
      const auto object = node.system.groupoid.coordinates_of_object(node.object);
      const auto arrow = node.system.groupoid.coordinates_of_arrow(node.configuration);
      VariedVector all_of_it(object.size() + n + arrow.size());
      all_of_it << object, node.momentum, arrow;
      return all_of_it;
    };
    SensitivityOptions<Sys> options;
    options.configuration = from;
    return std::make_unique<LinearisedMotionOf<Sys>>(
        changed, lagroid::detail::newton_integrator<Sys>(changed, start, options), parameters, observe);
  };
  return out;
}

}  // namespace lagroid::app
