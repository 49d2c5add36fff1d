#pragma once
/// From the nodes of a motion to the rows of its trajectory.
///
///     Recorder recorder(motion.look());
///     recorder.record(motion.look(), nullptr);  // or the judge, where a field is a drift
///
/// Requires that all nodes have the same fields.

#include <lagroid/run/ledger/judge.hpp>
#include <lagroid/run/motion/observables.hpp>
#include <lagroid/run/run_result.hpp>

namespace lagroid {

/// Records nodes: a row of every field.
class Recorder {
 public:
  /// Declares the columns, which those of the nodes to come are.
  explicit Recorder(const Observables& node);

  /// The judge has seen the node. Null where no field is a drift.
  void record(const Observables& node, const Judge* judge);

  Trajectory& trajectory() { return trajectory_; }

 private:
  Trajectory trajectory_;
};

}  // namespace lagroid
