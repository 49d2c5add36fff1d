#pragma once
/// What `lagroid gradient` needs of a scene, whatever its system: names, and motions that can be linearised.
///
///     const GradientSubject subject = ...;  // of a system's module (gradient_subject_of.hpp)
///     const auto motion = subject.begin({"mass"}, {});
///
/// Errors of `begin`: WithoutDerivative then, or at the first linearised step; std::invalid_argument for an unknown
/// name.

#include <lagroid/run/events/derivatives/event_derivatives.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion.hpp>
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

/// A number that can be asked for: by its own name, or with all others of its group.
struct GradientName {
  std::string group;
  std::string name;
  bool is_computed = false;   ///< of the state, of which it is no number of its own
  bool only_by_name = false;  ///< not among all that there are
  bool is_angle = false;      ///< from -pi to pi
};

/// By what a start differs: along direction `index` of (displacement, momentum), or a parameter where there is a name.
struct Nudge {
  int index = 0;
  std::string parameter = {};
  double by = 0;
};

/// Of a boundary value: the cost of the path that was found, and how it depends on the ends and on parameters.
struct BoundaryCost {
  std::string failure = {};  ///< where none was found
  long steps = 0;
  double value = 0;
  Eigen::RowVectorXd by_ends = {};  ///< in the order of GradientSubject::start
  Eigen::RowVectorXd by_parameters = {};
  /// The cost of the path that this one becomes where ends and parameters differ; none where it is not found.
  std::function<std::optional<double>(const std::vector<Nudge>&)> again = nullptr;
};

/// By what a run through events is linearised; a subject may do more than that.
enum class ThroughEvents { values_alone, parameters, start_too };

struct GradientSubject {
  std::string system;
  long steps = 0;
  std::vector<GradientName> observed;  ///< rows of what the motion observes at a node, in order
  /// What runs record beside these, and why it has no derivative.
  std::vector<std::pair<GradientName, std::string>> unobserved = {};
  std::vector<GradientName> start;       ///< directions of the start, in order
  std::vector<GradientName> parameters;  ///< all that are numbers
  std::vector<double> sizes;             ///< of start and parameters, for differences
  /// A motion to be linearised by these parameters, from a start that differs by all of the nudges.
  std::function<std::unique_ptr<LinearisedMotion>(const std::vector<std::string>& parameters,
                                                  const std::vector<Nudge>&)>
      begin;
  /// The state at the start by `start` and these parameters, where that is given by other numbers, as velocities; null
  /// where the state itself is.
  std::function<Eigen::MatrixXd(const std::vector<std::string>& parameters, const std::vector<Nudge>&)> begun_by =
      nullptr;
  /// Numbers by which there is no derivative, as initial.NAME and parameters.NAME, and why; whether they are among
  /// those of `start` and `parameters` or not.
  std::vector<std::pair<std::string, std::string>> refused = {};
  /// Why no scene has numbers that differ so: a parameter out of its range, a start off its constraint; empty where one
  /// has. Null where all are allowed.
  std::function<std::string(const std::vector<Nudge>&)> refusal = nullptr;
  double tolerance = 0;                  ///< to which runs from starts beside each other are values of one function
  std::vector<std::string> notes = {};   ///< on what derivatives hold
  std::vector<std::string> events = {};  ///< of the scene, by their names
  std::vector<char> events_decide = {};  ///< which of them change the motion or end it; the others only record
  /// The run through them, observed where they happen and at a node, or at the end for -1, by what is asked for; null
  /// in a scene without.
  std::function<EventSensitivities(const std::vector<std::string>& parameters, const std::vector<Nudge>&, long node,
                                   ThroughEvents)>
      through_events = nullptr;
  bool begins_through_events = false;  ///< whether motions of `begin` go through them
  /// Tells such a motion, before its first step, along which directions it is asked for; null where none wants to know.
  std::function<void(LinearisedMotion&, const Eigen::MatrixXd& directions)> begin_along = nullptr;
  /// Of a boundary value, by these parameters; `start` is then both ends. Null for a run.
  std::function<BoundaryCost(const std::vector<std::string>& parameters)> cost = nullptr;
};

/// Finds the parameters that are `refused`: those by which `differentiate` throws WithoutDerivative.
void find_refused(GradientSubject& subject,
                  const std::function<void(const std::vector<std::string>& parameters)>& differentiate);
/// Those by which the first step of `begin` has none.
void find_refused(GradientSubject& subject);

/// Adds the parameters of a system, and their sizes after those of the start.
template <class Sys> void name_parameters(const Sys& system, GradientSubject& subject) {
  const ParameterPlaces all = all_parameters(system);
  for (const std::string& name : all.names) subject.parameters.push_back({"parameters", name});
  for (const double* member : all.members) subject.sizes.push_back(*member);
}
template <class Sys> void nudge_parameters(Sys& system, const std::vector<Nudge>& nudges) {
  for (const Nudge& nudge : nudges) {
    if (nudge.parameter.empty()) continue;
    const ParameterPlaces of = places_of_parameters(system, {nudge.parameter});
    const_cast<double&>(*of.members.front()) += nudge.by;  // of `system`, which is no constant
  }
}

}  // namespace lagroid::app
