#pragma once
/// What is observed at the nodes of a system's run, over numbers with derivatives: object, momentum, configuration, and
/// what is computed of them, numbers of the system's own (core/capabilities/observed_numbers.hpp) and the places that
/// runs record of an arrow.
///
///     const ObservedColumns<Sys> observe(value, system);
///     out.observed = observe.names(timed);
///     const VariedVector numbers = observe(node);
///
/// Names are those of a run's columns and of its ledger. `without` has those of them that have no derivative, and why.
/// Errors: std::invalid_argument where the system has not as many numbers as names of its own.

#include "../../scenes/arrow_format.hpp"
#include "../../scenes/simulation.hpp"
#include "../../scenes/system_module.hpp"
#include "../gradient_subject.hpp"
#include "observed_slopes.hpp"

#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/motion/shape.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace differentiating {

template <class G> inline constexpr bool is_pair = false;
template <int N> inline constexpr bool is_pair<Pair<N>> = true;

/// Groupoids whose arrows scenes write by places over any scalar, attitudes apart (arrow_format.hpp).
template <class G> inline constexpr bool has_places = false;
template <> inline constexpr bool has_places<SE2> = true;
template <> inline constexpr bool has_places<SO2> = true;
template <> inline constexpr bool has_places<SO3> = true;
template <int N> inline constexpr bool has_places<Pair<N>> = true;
template <int N> inline constexpr bool has_places<VectorGroup<N>> = true;
template <class... Gs> inline constexpr bool has_places<Product<Gs...>> = (has_places<Gs> && ...);

/// Which of these places are angles from -pi to pi.
template <class G> std::vector<bool> angles_of(const G& /*groupoid*/) {
  return std::vector<bool>(ArrowFormat<G>::labels(ArrowFormat<G>::key).size(), false);
}
inline std::vector<bool> angles_of(const SE2& /*groupoid*/) { return {false, false, true}; }
inline std::vector<bool> angles_of(const SO2& /*groupoid*/) { return {true}; }
template <class... Gs> std::vector<bool> angles_of(const Product<Gs...>& /*groupoid*/) {
  std::vector<bool> out;
  const auto add = [&](const std::vector<bool>& more) { out.insert(out.end(), more.begin(), more.end()); };
  (add(angles_of(Gs{})), ...);
  return out;
}

inline void name_all(std::vector<GradientName>& out, const std::string& group, int count,
                     const std::vector<std::string>& labels) {
  for (int i = 0; i < count; ++i)
    out.push_back({group, int(labels.size()) == count ? labels[std::size_t(i)] : group + "." + std::to_string(i)});
}

/// On pairs the configuration is where the motion began and the position, and left out.
template <DiscreteSystem Sys> class ObservedColumns {
 public:
  using G = typename Sys::GroupoidType;
  static constexpr int objects = G::object_coordinate_count();
  static constexpr int arrows = is_pair<G> ? 0 : G::arrow_coordinate_count();

  ObservedColumns(const StatedInitialValue<Sys>& value, const Sys& system) {
    static_assert(observed_numbers_fit<Sys>,
                  "observed_names is there but observed(state, configuration) does not fit (see ObservesNumbers)");
    const Presentation<Sys>& presentation = value.presentation;
    name_all(state_, is_pair<G> ? "position" : "object", objects, presentation.position);
    name_all(state_, "momentum", Sys::dimension, presentation.momentum);
    name_all(configuration_, "configuration", arrows, {});
    if constexpr (ObservesNumbers<Sys>) {
      const auto plain = numbers_without_slopes(system, value.initial, value.configuration);
      const std::vector<ObservedName> names = Sys::observed_names();
      for (std::size_t i = 0; i < names.size(); ++i) {
        auto [group, name] = names[i];
        if (is_recorded(presentation, group)) std::swap(group, name);  // as that column is called
        if (is_there(name)) continue;
        if (const auto found = plain.find(i); found != plain.end()) {
          without_.push_back({{group, name}, found->second});
        } else {
          own_.push_back({group, name, true, true});
          own_at_.push_back(i);
        }
      }
    }
    name_places(value, system);
    leave_out(presentation, quantities_of(system));
  }

  /// `timed`: with the time, which motions by such steps observe after the momentum.
  std::vector<GradientName> names(bool timed) const {
    std::vector<GradientName> out = state_;
    if (timed) out.push_back({"time", "t"});
    for (const auto* more : {&configuration_, &own_, &places_}) out.insert(out.end(), more->begin(), more->end());
    return out;
  }
  const std::vector<std::pair<GradientName, std::string>>& without() const { return without_; }

  template <class Node> VariedVector operator()(const Node& node) const {
    VariedVector out(objects + Sys::dimension + arrows + Eigen::Index(own_.size() + places_.size()));
    out.head(objects) = node.system.groupoid.coordinates_of_object(node.object);
    out.segment(objects, Sys::dimension) = node.momentum;
    if constexpr (arrows > 0)
      out.segment(objects + Sys::dimension, arrows) = node.system.groupoid.coordinates_of_arrow(node.configuration);
    Eigen::Index at = objects + Sys::dimension + arrows;
    if constexpr (ObservesNumbers<Sys>)
      if (!own_.empty()) {
        const Vector<VariedNumber, Eigen::Dynamic> own =
            node.system.observed(State<G, VariedNumber>{node.object, node.momentum}, node.configuration);
        for (const std::size_t i : own_at_) out(at++) = own(Eigen::Index(i));
      }
    if constexpr (has_places<G>)
      if (!places_.empty())
        for (const VariedNumber& each :
             ArrowFormat<G>{node.system.groupoid}.template coordinates<VariedNumber>(node.configuration, node.object))
          out(at++) = each;
    return out;
  }

 private:
  static bool is_recorded(const Presentation<Sys>& presentation, const std::string& name) {
    return std::any_of(presentation.extras.begin(), presentation.extras.end(), [&](const ExtraColumns<Sys>& each) {
      const auto& all = each.series.components;
      return !each.series.on_arrows && all.size() == 1 && all.front() == name;
    });
  }
  bool is_there(const std::string& name) const {
    for (const auto* all : {&state_, &own_, &places_})
      if (std::any_of(all->begin(), all->end(), [&](const GradientName& each) { return each.name == name; }))
        return true;
    return false;
  }

  /// The places that runs record, where they are those of the configuration and no objects.
  void name_places(const StatedInitialValue<Sys>& value, const Sys& system) {
    const Presentation<Sys>& presentation = value.presentation;
    if (int(presentation.position.size()) == objects) return;
    if constexpr (has_places<G>) {
      // There, and at an arrow that has no two numbers alike.
      const ArrowFormat<G> format{system.groupoid};
      AlgebroidVector<G> v;
      for (int i = 0; i < Sys::dimension; ++i) v(i) = 0.1 + 0.07 * i;
      const ArrowOf<G> onward = system.groupoid.tau(value.initial.object, v);
      const auto are_recorded = [&](const ArrowOf<G>& configuration, const ObjectOf<G>& object) {
        TrajectoryPoint<Sys> point;
        point.state.object = object;
        point.configuration = configuration;
        return presentation.position_of(point) == format.coordinates(configuration, object);
      };
      if (are_recorded(value.configuration, value.initial.object) &&
          are_recorded(system.groupoid.compose(value.configuration, onward), system.groupoid.target(onward)))
        for (std::size_t i = 0; i < presentation.position.size(); ++i)
          places_.push_back({"position", presentation.position[i], true, true, angles_of(G{})[i]});
    }
  }

  void leave_out(const Presentation<Sys>& presentation, const std::vector<Quantity<Sys>>& quantities) {
    const auto add = [&](const std::string& group, const std::string& name, const std::string& why) {
      if (!is_there(name)) without_.push_back({{group, name}, why});
    };
    for (const std::string& each : presentation.position)
      add("position", each, "it is recorded of the configuration; ask for numbers of that, configuration.0");
    if (presentation.has_attitude)
      for (const std::string& each : attitude_columns)
        add("attitude", each,
            "a quaternion is known up to its sign; ask for numbers of the rotation matrix, configuration.0");
    for (const std::string& each : presentation.multipliers)
      add("multipliers", each, "multipliers are of arrows, not of nodes");
    for (const ExtraColumns<Sys>& each : presentation.extras)
      for (const std::string& name : each.series.components)
        add(each.series.name, name,
            each.series.on_arrows ? "it is of arrows, not of nodes"
                                  : "the system writes it over plain numbers alone, not among its observed numbers");
    for (const Quantity<Sys>& each : quantities) {
      const bool one = each.components.size() == 1;
      for (const std::string& name : each.components)
        add(one ? name : each.name, one ? each.name : name,
            each.serialize != nullptr ? "it adds up along the run, and is no function of a node"
            : each.needs_step         ? "it is of arrows, not of nodes"
                              : "the system writes it over plain numbers alone, not among its observed numbers");
    }
  }

  std::vector<GradientName> state_;
  std::vector<GradientName> configuration_;
  std::vector<GradientName> own_;
  std::vector<std::size_t> own_at_;  ///< among those of the system
  std::vector<GradientName> places_;
  std::vector<std::pair<GradientName, std::string>> without_;
};

}  // namespace differentiating

}  // namespace lagroid::app
