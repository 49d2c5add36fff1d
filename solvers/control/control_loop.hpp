#pragma once
/// Model predictive control on a groupoid: at each sample the optimal control problem is solved anew, from where the
/// motion is found to be, and the first control of the plan is applied.
///
///     ControlLoop<SatelliteTurn> loop(task, 50);
///     for (ControlReport report = loop.begin(); report.converged();) {
///       apply(loop.control());
///       report = loop.advance(from(measured_state()));  // a sample later, to the end
///     }
///
/// The horizon moves on with the motion: as many stages of the same step, toward the same end. Each solve goes on from
/// the last plan, moved on by a stage, and from its multipliers, so that a few iterations of Newton's method are left,
/// on the manifold of trajectories itself. Memory is that of the first solve; `advance` allocates nothing.
///
/// Requires what solve_control does, a duration that is not free, and an end at which the motion can rest for what the
/// horizon moves beyond it. Where a solve does not converge in the iterations that it is allowed, the report says so,
/// and the plan is the last iterate: `is_usable` says whether it satisfies its constraints to a tolerance of one's own.
/// `restart` plans anew from the straight trajectory.
///
/// With `iterations` of one it is the real-time iteration of Diehl, Bock and Schloeder (SIAM J. Control Optim. 43,
/// 2005): one Newton step a sample, whose errors contract from sample to sample.
///
/// Errors: std::invalid_argument for a free duration, and those of solve_control.

#include <lagroid/solvers/control/latency.hpp>
#include <lagroid/solvers/control/solve_control.hpp>

#include <chrono>
#include <stdexcept>

namespace lagroid {

struct ControlLoopOptions {
  int iterations = 20;  ///< of a sample, at most
  ControlOptions solver = {.tolerance = 1e-8};
};

template <class Sys> class ControlLoop {
 public:
  using G = typename Sys::GroupoidType;

  /// From a plan of one's own, as the cheapest of `search_control`.
  ControlLoop(const ControlTask<Sys>& task, ControlTrajectory<Sys> plan, const ControlLoopOptions& options = {})
      : options_(checked(options, task, plan)),
        task_(task),
        transcription_(task, std::move(plan)),
        solver_(transcription_, options.solver) {}
  ControlLoop(const ControlTask<Sys>& task, long stages, const ControlLoopOptions& options = {})
      : ControlLoop(task, straight_trajectory(task, std::max(stages, 2L)), options) {}
  ControlLoop(const ControlLoop&) = delete;  // the solver knows the transcription by its place
  ControlLoop& operator=(const ControlLoop&) = delete;

  /// Solves the first problem, from the plan as it stands, with as many iterations as the solver takes.
  ControlReport begin() { return solver_.solve(); }
  /// A sample later: `boundary` leads from where the motion is now to the end.
  ControlReport advance(const ArrowOf<G>& boundary) {
    return timed([&] {
      transcription_.move_on(boundary);
      solver_.move_on();
      return solver_.resume(options_.iterations);
    });
  }
  /// The same of a motion of which the last plan says nothing.
  ControlReport restart(const ArrowOf<G>& boundary) {
    return timed([&] {
      task_.boundary = boundary;
      transcription_.stand_at(straight_trajectory(task_, long(plan().arrows.size())), boundary);
      return solver_.solve();
    });
  }
  /// The boundary of the next sample if the motion has followed the plan but for `off`, in the algebroid there.
  ArrowOf<G> followed(const AlgebroidVector<G>& off = AlgebroidVector<G>::Zero()) const {
    const G& groupoid = task_.system.groupoid;
    const ArrowOf<G> rest = groupoid.compose(groupoid.inverse(plan().arrows.front()), transcription_.boundary());
    return groupoid.compose(groupoid.inverse(groupoid.tau(groupoid.source(rest), off)), rest);
  }

  /// The control to be applied until the next sample.
  const Vector<double, Sys::controls>& control() const { return plan().controls.front(); }
  const ControlTrajectory<Sys>& plan() const { return transcription_.trajectory(); }
  /// Of the calls of `advance` and `restart`.
  const Latency& latency() const { return latency_; }

  /// Whether a plan that did not converge satisfies its constraints so well that it may be followed.
  static bool is_usable(const ControlReport& report, double violation) { return report.violation <= violation; }

 private:
  static const ControlLoopOptions& checked(const ControlLoopOptions& options, const ControlTask<Sys>& task,
                                           const ControlTrajectory<Sys>& plan) {
    if (task.duration_is_free)
      throw std::invalid_argument("a control loop looks ahead for a time that is given: its duration is not free");
    require_control_task(task, plan);
    return options;
  }

  template <class Solve> ControlReport timed(const Solve& solve) {
    const auto before = std::chrono::steady_clock::now();
    const ControlReport report = solve();
    latency_.add(std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count());
    return report;
  }

  ControlLoopOptions options_;
  ControlTask<Sys> task_;
  TranscriptionOf<Sys> transcription_;
  InteriorPoint solver_;
  Latency latency_;
};

}  // namespace lagroid
