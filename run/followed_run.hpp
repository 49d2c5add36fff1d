#pragma once
/// A run that is followed in pieces: so many steps, a look at columns and ledger, and so many steps more.
///
/// `drive` (motion/drive.hpp) goes through one at once and adds what a command needs, checkpoints, a bar and signals; a
/// page that shows a run while it is computed asks for as many steps as fit into a frame.
///
///     RunResult result;
///     FollowedRun run(motion, {.steps = 1000}, true, result);
///     while (run.goes_on()) run.advance(50), show(run.ledger());
///     run.finish();  // and the result is that of the whole run
///
/// Requires a motion at its first node, and that motion and result outlive it. Errors: RunError where an event cannot
/// be watched for.

#include <lagroid/run/events/event_watch.hpp>
#include <lagroid/run/ledger/judge.hpp>
#include <lagroid/run/motion/drive.hpp>
#include <lagroid/run/motion/integrate_nodes.hpp>
#include <lagroid/run/motion/recorder.hpp>

#include <functional>
#include <optional>

namespace lagroid {

class FollowedRun {
 public:
  FollowedRun(Motion& motion, const RunExtent& extent, bool record, RunResult& result);
  FollowedRun(const FollowedRun&) = delete;
  FollowedRun& operator=(const FollowedRun&) = delete;

  /// Sees the first node.
  void begin() { watched_.observe(); }
  /// Makes at most so many steps, fewer where the run ends or `goes_on`, which is asked after each, says no.
  void advance(long steps, const std::function<bool(const StepReport&)>& goes_on = nullptr);
  /// How the last steps ended.
  const IntegrationEnd& end() const { return end_; }
  /// Whether there is something left to do.
  bool goes_on() const;
  /// The ledger up to the last node.
  Ledger ledger() const;
  /// What has happened up to it.
  const EventTable& happened() const { return events_ ? events_->table() : result_.events; }
  /// Says in the result how the run ended, in the words for what stopped it.
  void tell_end();
  /// Completes the result: the last row, the ledger, what happened, pictures.
  void finish();

  Motion& motion() { return motion_; }
  Trajectory& trajectory() { return recorder_.trajectory(); }

  /// Visits all that the run goes on from (archive.hpp).
  template <class Archive> void serialize(Archive& archive) {
    archive.numbers("motion", [&](auto& numbers) { motion_.serialize(numbers); });
    archive("judge", judge_);
    archive("watched", watched_);
    if (events_) archive("events", *events_);
  }

 private:
  void count(const StepReport& report);

  Motion& motion_;
  RunResult& result_;
  long steps_;
  bool record_;
  const Observables& first_;
  Judge judge_;
  Recorder recorder_;
  WatchedMotion watched_;
  std::optional<EventWatch> events_;
  IntegrationEnd end_;
};

}  // namespace lagroid
