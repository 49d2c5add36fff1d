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
/// has another sign at the end of a step than at its beginning, where it is zero there, or where it comes near zero in
/// between: then its extremum is looked for, which lies beyond zero (two events), or nearer than the event's tolerance
/// (Passing::touching). A function that is zero at the start has not passed it there. (FunctionWatch)
///
/// Errors: RunError for a function that cannot be read, with the columns there are, for a name or a count that is none,
/// and for a motion whose steps cannot be made in part, or that cannot be changed so on the way.
/// `pass` returns `failed` where a partial step does not converge, where kicks follow each other without end, where the
/// motion refuses a change, and where what is added, or measured afterwards, is no finite number.

#include <lagroid/run/events/event.hpp>
#include <lagroid/run/events/event_function.hpp>
#include <lagroid/run/events/function_watch.hpp>
#include <lagroid/run/motion/integrate_nodes.hpp>
#include <lagroid/run/motion/motion.hpp>

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace lagroid {

/// A quantity inside of a step, and the size of the terms that it is made of.
struct QuantityWithin {
  std::vector<double> value;
  double size = 0;
};

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
    begun_ = time_;
    arrived_ = node.time();
    step_ = node.index();
    for (std::size_t i = 0; i < watches_.size(); ++i)
      if (watches_[i].function.next(watches_[i].value(node), arrived_)) suspects_.push_back(i);
    const Goes goes = suspects_.empty() ? Goes::on : look_into_step();
    time_ = arrived_;
    return goes;
  }
  /// What was changed since is no fault of the motion.
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
  /// An event, what is known of its function, and what it adds and sets.
  struct Watch {
    Event event;
    EventFunction value;
    std::vector<EventFunction> kick;
    std::vector<EventFunction> set;
    FunctionWatch function;
    std::size_t kicked_at = 0;  ///< of the numbers of all momenta the first
    long changes = 0;           ///< of the motion
    template <class Archive> void serialize(Archive& archive) {
      archive("function", function);
      archive("changes", changes);
    }
  };
  struct Found {
    std::size_t event;
    double share;
    Passing passing;
  };
  using Group = std::span<const Found>;  ///< of those that happen together

  Goes look_into_step();
  Goes look_into_rest(std::vector<Found>& found);
  std::vector<Found> find_in_step();
  const Observables& within(double share);
  /// Changes the motion as these do; false where they change nothing.
  bool change(Group together);
  /// Adds what one of them does at the point where it happens.
  void add_change(Watch& watch, const Observables& inside, MotionChange& change) const;
  void measure_change(const std::vector<QuantityWithin>& before, const Observables& changed);
  /// Records it; false where the run ends.
  bool happens(const Found& found);
  std::vector<double> flat_rows() const;
  void restore(const std::vector<double>& rows);

  Motion& motion_;
  std::vector<Watch> watches_;
  EventTable table_;
  double time_;     ///< of the node before
  double arrived_;  ///< at the node after
  double begun_;    ///< where the step begins, or what a change left of it
  long step_ = 0;   ///< which leads there
  std::vector<std::size_t> suspects_;
  std::size_t looking_for_ = 0;  ///< of the watches, for a message
  bool looked_within_ = false;
  const Observables* end_ = nullptr;
  std::vector<QuantityWithin> shifts_;  ///< what changes of the motion have moved them by since the last node
  std::string reason_;
};

/// As `integrate_nodes` of steps alone, with what happens in them; ends where an event ends the run, too.
IntegrationEnd integrate_nodes(WatchedMotion& watched, EventWatch& events, long count,
                               const std::function<bool(const StepReport&)>& goes_on);

}  // namespace lagroid
