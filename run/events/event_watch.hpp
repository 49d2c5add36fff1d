#pragma once
/// Watches for events while a motion runs: after each step it finds what happened in it, by steps of the same method
/// that are made in part.
///
/// The motion does not notice: with recorded events its nodes have the bits that they have without.
///
///     EventWatch watch({{.name = "section", .when = "q1"}}, motion);
///     watch.keep();
///     if (motion.advance().converged()) std::cout << (watch.pass(motion.look()) == EventWatch::Goes::ended) << '\n';
///
/// Requires that motion outlives it, and every step of it to be passed. An event at zero is found where its function
/// has another sign at the end of a step than at its beginning (zero counts as positive), or where it comes near zero
/// in between: then its extremum is looked for, which lies beyond zero (two events), or nearer than the event's
/// tolerance (Passing::touching). A function that is zero at the start has not passed it there.
///
/// Errors: RunError for a function that cannot be read, with the columns there are, for a name or a count that is none,
/// and for a motion whose steps cannot be made in part, or whose momentum cannot be kicked. `pass` returns `failed`
/// where a partial step does not converge, and where kicks follow each other without end.

#include <lagroid/run/events/event.hpp>
#include <lagroid/run/events/event_function.hpp>
#include <lagroid/run/events/within_step.hpp>
#include <lagroid/run/motion/integrate_nodes.hpp>
#include <lagroid/run/motion/motion.hpp>

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lagroid {

class EventWatch {
 public:
  enum class Goes { on, ended, failed };

  /// From the node where the motion is.
  EventWatch(const std::vector<Event>& events, Motion& motion);

  /// Before a step.
  void keep() { motion_.keep_node(); }
  /// After it, at the node that it led to.
  Goes pass(const Observables& node) {
    looked_within_ = false;
    suspects_.clear();
    arrived_ = node.time();
    step_ = node.index();
    for (std::size_t i = 0; i < watches_.size(); ++i)
      if (watches_[i].goes_on_to(node)) suspects_.push_back(i);
    const Goes goes = suspects_.empty() ? Goes::on : look_into_step();
    time_ = arrived_;
    return goes;
  }
  /// What kicks have changed since is no fault of the motion.
  void settle(Judge& judge);
  /// Whether the motion has to be looked at anew since.
  bool looked_within() const { return looked_within_; }
  /// Where the run ended; until the motion is looked at anew.
  const Observables& end() const { return *end_; }
  /// Why: by which event, or which partial step did not converge.
  const std::string& reason() const { return reason_; }

  const EventTable& table() const { return table_; }
  /// Adds the table, what the ledger counts, and notes on events that touched zero, or whose functions were undefined.
  void report(RunResult& result) const;
  /// Visits what it has seen.
  template <class Archive> void serialize(Archive& archive) {
    for (std::size_t i = 0; i < watches_.size(); ++i) archive("event " + std::to_string(i), watches_[i]);
    archive("time", time_);
    std::vector<double> rows = archive.restoring() ? std::vector<double>() : flat_rows();
    archive("rows", rows);
    if (archive.restoring()) restore(rows);
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  /// An event with the values of its function at the last nodes.
  struct Watch {
    Event event;
    EventFunction function;
    std::vector<EventFunction> kick;
    double now = unknown;
    double before = unknown;
    double change = unknown;        ///< over the step before
    double slope = unknown;         ///< at this node, where it was asked for
    double slope_before = unknown;  ///< at that before: a turn at a node belongs to one of two steps
    double largest = 0;
    bool starts_at_zero = false;
    long undefined = 0;  ///< nodes at which the function was no finite number
    double undefined_at = 0;

    /// Whether something may have happened in the step.
    bool goes_on_to(const Observables& node);
    /// The same in the rest of a step from where the motion was kicked, with this value; `passing` there, if it did.
    bool goes_on_from(double kicked, std::optional<Passing> passing, const Observables& node);
    void see(const Observables& node);
    /// Whether it passed zero in a direction that counts, from the node before to this one.
    bool passes_zero() const { return (before < 0) != (now < 0) && counts(before, now); }
    bool counts(double from, double to) const {
      return event.direction == Event::Direction::both || (event.direction == Event::Direction::rising) == (from < to);
    }
    bool may_touch() const;
    bool may_turn() const;
    template <class Archive> void serialize(Archive& archive) {
      archive("now", now);
      archive("before", before);
      archive("change", change);
      archive("slope", slope);
      archive("largest", largest);
      archive("starts at zero", starts_at_zero);
      archive("undefined", undefined);
      archive("undefined at", undefined_at);
    }
  };
  struct Found {
    std::size_t event;
    double share;
    Passing passing;
  };

  Goes look_into_step();
  void look_for_zeros(std::size_t i, std::vector<Found>& found);
  void look_for_extremum(std::size_t i, std::vector<Found>& found);
  /// Where in the step the function of an event is smallest or largest, if it is somewhere.
  std::optional<double> turn_of(std::size_t i, const StepFunction& g, bool is_minimum);
  double value_at(std::size_t i, double share);
  void find_in_step(std::vector<Found>& found, std::size_t& looking_for);
  /// Adds to the momentum what these, which happen together, add; false where that is nothing.
  bool kick(std::span<const Found> together);
  /// Records it; false where the run ends.
  bool happens(const Found& found);
  std::vector<double> flat_rows() const;
  void restore(const std::vector<double>& rows);

  Motion& motion_;
  std::vector<Watch> watches_;
  EventTable table_;
  double time_;     ///< of the node before
  double arrived_;  ///< at the node after
  long step_ = 0;   ///< which leads there
  std::vector<std::size_t> suspects_;
  bool looked_within_ = false;
  const Observables* end_ = nullptr;
  std::vector<std::vector<double>> kicked_;  ///< of every quantity, what kicks have changed since the last node
  std::string reason_;
};

/// As `integrate_nodes` of steps alone, with what happens in them; ends where an event ends the run, too.
IntegrationEnd integrate_nodes(WatchedMotion& watched, EventWatch& events, long count,
                               const std::function<bool(const StepReport&)>& goes_on);

}  // namespace lagroid
