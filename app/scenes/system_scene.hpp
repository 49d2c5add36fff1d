#pragma once
/// What any system reads from a scene, and its words in reports: parameters as it declares them, arrows as scenes write
/// them (arrow_format.hpp).
///
///     const auto system = read_system<Sys>(scene);
///     const Presentation<Sys> presentation = dressed<Sys>(system, "dido", nullptr);
///     const InitialValue<Sys> initial = read_initial(system, scene, presentation.momentum);
///
/// Errors: SceneError for a mistake in the scene.

#include "../keys/parameter.hpp"
#include "arrow_format.hpp"
#include "attitude.hpp"
#include "simulation.hpp"
#include "system_module.hpp"

#include <lagroid/run/run.hpp>

#include <fmt/ranges.h>

#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

/// Changes a presentation where reports need more than they can deduce: labels, units, panels, shapes.
template <class Sys> using Dress = void (*)(Presentation<Sys>& presentation, const Sys& system);

/// The presentation that is deduced for any system: the numbers of its configuration, its attitude where it has one,
/// its momenta mu1, mu2, ... and what it keeps.
template <DiscreteSystem Sys> Presentation<Sys> presentation_of(const Sys& system, std::string_view name) {
  using G = typename Sys::GroupoidType;
  using Point = TrajectoryPoint<Sys>;
  const ArrowFormat<G> spoken{system.groupoid};
  Presentation<Sys> p;
  p.name = name;
  p.position = spoken.labels(ArrowFormat<G>::key);
  p.position_unit = "of the configuration's coordinates";
  p.position_of = [spoken](const Point& point) { return spoken.coordinates(point.configuration, point.state.object); };
  State<G> somewhere;
  p.has_attitude = spoken.attitude(system.groupoid.unit(somewhere.object)).has_value();
  if (p.has_attitude) p.attitude_of = [spoken](const Point& point) { return *spoken.attitude(point.configuration); };
  p.momentum = lagroid::detail::numbered("mu", G::dimension);
  p.momentum_unit = "action / unit of the retraction's coordinates";
  p.multipliers = lagroid::detail::numbered("lambda", Sys::constraints);
  if (!p.position.empty()) p.panels.push_back({"configuration", "t", "q", "t", p.position});
  if (p.has_attitude) p.panels.push_back(attitude_panel());
  p.panels.push_back({"momentum", "t", "mu", "t", p.momentum});
  for (const auto& q : quantities_of(system))
    p.panels.push_back({q.name + " error", "t", "deviation", "t", {"drift " + q.name}});
  p.conventions = {{"state", "configuration and momentum mu at the nodes, in the basis of the retraction"}};
  if (p.has_attitude) p.conventions["attitude"] = "A_k = A_{k-1} g_k";
  return p;
}

template <DiscreteSystem Sys> Presentation<Sys> dressed(const Sys& system, std::string_view name, Dress<Sys> dress) {
  Presentation<Sys> p = presentation_of(system, name);
  if (dress) dress(p, system);
  return p;
}

/// `momentum` of [initial], of which these are the names.
template <DiscreteSystem Sys> KeyOf<NumberArray> momentum_key(const std::vector<std::string>& labels) {
  return {"momentum", {std::size_t(Sys::GroupoidType::dimension)}, "", fmt::format("{}", fmt::join(labels, ", "))};
}

/// The keys of any system, read as below and by `read_ends` (any_system.hpp).
template <DiscreteSystem Sys> SystemKeys keys_of(std::string_view name, Dress<Sys> dress) {
  using G = typename Sys::GroupoidType;
  SystemKeys keys{.parameters = parameter_keys<Sys>(), .initial = arrow_keys<G>()};
  keys.initial.push_back(momentum_key<Sys>(dressed(Sys{}, name, dress).momentum));
  if constexpr (Variational<Sys>) keys.end = arrow_keys<G>();
  return keys;
}

/// The system of a scene: its [parameters], its step and, where it depends on time, when it starts.
template <DiscreteSystem Sys> Sys read_system(const Section& scene) {
  auto system = read_parameters<Sys>(scene);
  if constexpr (HasTimeStep<Sys>) system.h = read_time(scene).step;
  if constexpr (TimeDependent<Sys>) set_time(system, read_start(scene));
  return system;
}

/// The arrow that a table gives; refused where it ends off the object constraints.
template <DiscreteSystem Sys>
ArrowOf<typename Sys::GroupoidType> read_configuration(const Sys& system, const Section& section) {
  using G = typename Sys::GroupoidType;
  const auto arrow = ArrowFormat<G>{system.groupoid}.read(section, ArrowFormat<G>::key);
  if constexpr (Sys::object_constraints > 0) {
    const auto q = system.groupoid.target(arrow);
    const double off = system.object_constraint(q).cwiseAbs().maxCoeff();
    constexpr double on_it = 1e-8;
    if (!(off <= on_it * (1 + system.groupoid.coordinates_of_object(q).squaredNorm())))
      section.fail(ArrowFormat<G>::key, fmt::format("is off the constraint C(q) = 0 by {:.3g}", off));
  }
  return arrow;
}

template <DiscreteSystem Sys> struct InitialValue {
  State<typename Sys::GroupoidType> state;
  ArrowOf<typename Sys::GroupoidType> configuration;
};
/// [initial]: a configuration and `momentum`.
template <DiscreteSystem Sys>
InitialValue<Sys> read_initial(const Sys& system, const Section& scene, const std::vector<std::string>& labels) {
  using G = typename Sys::GroupoidType;
  const Section initial = scene.section("initial", "configuration and momentum");
  InitialValue<Sys> value;
  value.configuration = read_configuration(system, initial);
  value.state.object = system.groupoid.target(value.configuration);
  const auto momentum = read_key(initial, momentum_key<Sys>(labels));
  value.state.momentum = Eigen::Map<const AlgebroidVector<G>>(momentum.data());
  return value;
}

}  // namespace lagroid::app
