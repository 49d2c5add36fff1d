#pragma once
/// The loop over the nodes of a motion: step, judge, record.
///
///     WatchedMotion watched(motion, &judge, &recorder, 1);  // every node is recorded
///     const IntegrationEnd end = integrate_nodes(watched, 1000, [](const StepReport&) { return true; });
///
/// Requires that motion, judge and recorder outlive it. A step that fails is not made; the end has its report.

#include <lagroid/run/ledger/judge.hpp>
#include <lagroid/run/motion/motion.hpp>
#include <lagroid/run/motion/recorder.hpp>

#include <functional>

namespace lagroid {

/// A motion whose nodes are seen by a judge and, each n-th and the last, by a recorder.
class WatchedMotion {
 public:
  /// From the node on where the motion is, which the judge may have seen already. Judge and recorder may be null; all
  /// must outlive this.
  WatchedMotion(Motion& motion, Judge* judge, Recorder* recorder, long every, bool is_judged = false)
      : motion_(motion),
        judge_(judge),
        recorder_(recorder),
        every_(every),
        first_(motion.index()),
        next_(first_),
        judged_(is_judged ? first_ : -1) {}

  Motion& motion() { return motion_; }
  /// Sees the node where the motion is; false where its numbers are not finite.
  bool observe();
  /// The same of that node, which has been looked at.
  bool observe(const Observables& node);
  /// Sees the last node, where that was passed over.
  bool observe_last();
  Judge* judge() { return judge_; }
  /// Ends the rows with a point inside of the last step, in place of the node that this leads to.
  void end_at(const Observables& inside);
  /// Visits what it goes on from, beside motion and judge: after the motion.
  template <class Archive> void serialize(Archive& archive) {
    archive("judged", judged_);
    if (archive.restoring()) next_ = motion_.index() - (motion_.index() - first_) % every_ + every_;
  }

 private:
  /// Whether the node is one that is recorded; the next one to be is then a later one.
  bool takes_row();
  bool see(const Observables& node, bool is_recorded);

  Motion& motion_;
  Judge* judge_;
  Recorder* recorder_;
  long every_;
  bool is_judged_at_every_node_ = motion_.is_judged_at_every_node();
  long first_;
  long next_;    ///< the node to be recorded next
  long judged_;  ///< the last node that the judge saw
  bool is_ended_ = false;
};

/// How a loop over steps ended.
struct IntegrationEnd {
  enum class Why { whole, failed, not_finite, stopped, event };
  Why why = Why::whole;
  StepReport report;  ///< of the last step, unless all were made
};

/// Makes `count` steps and sees their nodes; fewer where a step fails, which is then not made, where the numbers of its
/// node are not finite, or where `goes_on(report)`, called after each step that was made, returns false.
IntegrationEnd integrate_nodes(WatchedMotion& watched, long count,
                               const std::function<bool(const StepReport&)>& goes_on);

}  // namespace lagroid
