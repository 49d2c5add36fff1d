#pragma once
/// What `lagroid gradient` needs of a scene, whatever its system: names, and motions that can be linearised.
///
///     const GradientSubject subject = ...;  // of a system's module (gradient_subject_of.hpp)
///     const auto motion = subject.begin({"mass"}, {});
///
/// Errors of `begin`: WithoutDerivative then, or at the first linearised step; std::invalid_argument for an unknown
/// name.

#include <lagroid/run/events/event_derivatives.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::app {

/// A number that can be asked for: by its own name, or with all others of its group.
struct GradientName {
  std::string group;
  std::string name;
};

/// By what a start differs: along direction `index` of (displacement, momentum), or a parameter where there is a name.
struct Nudge {
  int index = 0;
  std::string parameter = {};
  double by = 0;
};

struct GradientSubject {
  std::string system;
  long steps = 0;
  std::vector<GradientName> observed;    ///< rows of what the motion observes at a node, in order
  std::vector<GradientName> start;       ///< directions of the start, in order
  std::vector<GradientName> parameters;  ///< all that are numbers
  std::vector<double> sizes;             ///< of start and parameters, for differences
  /// A motion to be linearised by these parameters, from a start that differs by all of the nudges.
  std::function<std::unique_ptr<LinearisedMotion>(const std::vector<std::string>& parameters,
                                                  const std::vector<Nudge>&)>
      begin;
  std::vector<std::string> events = {};  ///< of the scene, by their names
  /// The run through them, observed where they happen and at a node, or at the end for -1; null in a scene without.
  std::function<EventSensitivities(const std::vector<std::string>& parameters, const std::vector<Nudge>&, long node)>
      through_events = nullptr;
};

}  // namespace lagroid::app
