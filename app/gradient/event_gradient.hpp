#pragma once
/// The derivatives of `lagroid gradient` of a run through events: of the end or a node, as ever, and of where events
/// happen.
///
///     const GradientTable table = differentiate_through_events(subject, {"event.floor.1.t"}, {"initial"}, false);
///
/// Rows are final.NAME, final.t, node.K.NAME, events (the times of all), event.NAME.K and event.NAME.K.COLUMN, K from
/// one. Errors: GradientRefused, one line, for what has no derivative, no such name, or has not happened.

#include "gradient_table.hpp"

#include <lagroid/run/events/derivatives/motion_through_events.hpp>
#include <lagroid/run/events/event.hpp>
#include <lagroid/run/expressions/varied_expression.hpp>
#include <lagroid/run/motion/motion.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

/// The texts of an event of a scene, of the time `t` and of what is observed.
struct EventExpressions {
  /// Throws std::invalid_argument for an event that has no derivative, or texts that are none.
  EventExpressions(const Event& event, const std::vector<GradientName>& observed, int momenta);

  VariedExpression when;
  std::vector<VariedExpression> kick;
  std::vector<std::pair<std::string, VariedExpression>> set;  ///< numbers, by the names of what they are set to be
};

/// The event with these texts, without its kick and its switches. Throws std::invalid_argument for one that sets
/// numbers where the motion `sets` none with derivatives.
ObservedEvent observed_event(const Event& event, const std::shared_ptr<EventExpressions>& texts, bool sets = false);
/// The events of a scene of one vector of so many momenta. Throws std::invalid_argument for one that has no derivative.
std::vector<ObservedEvent> observed_events(const std::vector<Event>& events, const std::vector<GradientName>& observed,
                                           int momenta, bool sets);
/// The names of all numbers that these set.
std::vector<std::string> numbers_set(const std::vector<ObservedEvent>& events);

/// Leads the motions of a subject that has all but its events through these: `begin` begins motions as the subject's
/// does.
using BeginCuttable = std::function<std::unique_ptr<CuttableMotion>(const std::vector<std::string>& parameters,
                                                                    const std::vector<Nudge>& nudges)>;
void go_through_events(const BeginCuttable& begin, const std::vector<ObservedEvent>& events, GradientSubject& subject);

GradientTable differentiate_through_events(const GradientSubject& subject, const std::vector<std::string>& of,
                                           const std::vector<std::string>& by, bool check);

/// The same as `values_of`, of a scene with events.
std::optional<ValuesBeside> values_through_events(const GradientSubject& subject, const GradientTable& table,
                                                  const std::vector<Nudge>& nudges);

/// Throws std::invalid_argument for events that a run of the motion would refuse.
void require_events(const std::vector<Event>& events, Motion& motion);

}  // namespace lagroid::app
