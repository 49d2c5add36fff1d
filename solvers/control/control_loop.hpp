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
/// and the plan is the last iterate: `ControlReport::is_usable` says whether it satisfies its constraints to a
/// tolerance of one's own. `restart` plans anew from the straight trajectory.
///
/// With `iterations` of one it is the real-time iteration of Diehl, Bock and Schloeder (SIAM J. Control Optim. 43,
/// 2005): one Newton step a sample, whose errors contract from sample to sample.
///
/// Errors: std::invalid_argument for a duration or ends that are free, and those of solve_control.

#include <lagroid/solvers/control/latency.hpp>
#include <lagroid/solvers/control/solve_control.hpp>

#include <algorithm>
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
        solver_(transcription_, options.solver) {
    task_.duration = this->plan().duration();
  }
  ControlLoop(const ControlTask<Sys>& task, long stages, const ControlLoopOptions& options = {})
      : ControlLoop(task, straight_trajectory(task, std::max(stages, 1L)), options) {}
  /// From a solution: `begin` goes on from its multipliers.
  ControlLoop(const ControlTask<Sys>& task, const ControlSolution<Sys>& known, const ControlLoopOptions& options = {})
      : ControlLoop(task, known.trajectory, options) {
    StageRows costates(long(known.costates.size()), transcription_.sizes().equality);
    StageRows multipliers(long(known.costates.size()), transcription_.sizes().inequality);
    for (long k = 0; k < long(known.costates.size()); ++k) {
      std::copy(known.costates[std::size_t(k)].begin(), known.costates[std::size_t(k)].end(), costates[k]);
      std::copy(known.inequality_multipliers[std::size_t(k)].begin(),
                known.inequality_multipliers[std::size_t(k)].end(), multipliers[k]);
    }
    solver_.take_multipliers(costates, multipliers);
    is_known_ = true;
  }
  ControlLoop(const ControlLoop&) = delete;  // the solver knows the transcription by its place
  ControlLoop& operator=(const ControlLoop&) = delete;

  /// Solves the first problem, from the plan as it stands, with as many iterations as the solver takes.
  ControlReport begin() {
    if (is_known_)
      if (const ControlReport report = solver_.resume(options_.solver.max_iterations); report.converged())
        return report;
    return solver_.solve();
  }
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
    return timed([&] { return start_anew(boundary); });
  }
  /// The same as `advance`, and where its plan is not usable, as `restart`: in one sample.
  ControlReport follow(const ArrowOf<G>& boundary, double usable) {
    return timed([&] {
      transcription_.move_on(boundary);
      solver_.move_on();
      ControlReport report = solver_.resume(options_.iterations);
      if (report.converged() || report.is_usable(usable)) return report;
      ++restarts_;
      const int in_vain = report.iterations;
      report = start_anew(boundary);
      report.iterations += in_vain;
      return report;
    });
  }
  long restarts() const { return restarts_; }  ///< of `follow`

  /// The boundary of the next sample if the motion has followed the plan but for `off`, in the algebroid there.
  ArrowOf<G> followed(const AlgebroidVector<G>& off = AlgebroidVector<G>::Zero()) const {
    const G& groupoid = task_.system.groupoid;
    const ArrowOf<G> rest = groupoid.compose(groupoid.inverse(plan().arrows.front()), transcription_.boundary());
    return groupoid.compose(groupoid.inverse(groupoid.tau(groupoid.source(rest), off)), rest);
  }

  /// The control to be applied until the next sample: that of the plan, within its bounds even where the plan, of a
  /// solve that did not converge, is not.
  Vector<double, Sys::controls> control() const {
    return plan().controls.front().cwiseMax(task_.lower).cwiseMin(task_.upper);
  }
  const ControlTrajectory<Sys>& plan() const { return transcription_.trajectory(); }
  /// Of the calls of `advance`, `restart` and `follow`.
  const Latency& latency() const { return latency_; }

 private:
  static const ControlLoopOptions& checked(const ControlLoopOptions& options, const ControlTask<Sys>& task,
                                           const ControlTrajectory<Sys>& plan) {
    if (!task.phases.empty())
      throw std::invalid_argument("a control loop looks ahead in one phase: its task has no list of them");
    if (task.duration_is_free)
      throw std::invalid_argument("a control loop looks ahead for a time that is given: its duration is not free");
    for (const auto& ends : {task.free_start, task.free_end})
      if (std::any_of(ends.begin(), ends.end(), [](bool free) { return free; }))
        throw std::invalid_argument("a control loop is between states that are given: its ends are not free");
    require_control_task(task, plan);
    return options;
  }

  ControlReport start_anew(const ArrowOf<G>& boundary) {
    task_.boundary = boundary;
    transcription_.stand_at(straight_trajectory(task_, long(plan().arrows.size())), boundary);
    return solver_.solve();
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
  bool is_known_ = false;  ///< the multipliers, too, of the plan as it stands
  long restarts_ = 0;
  Latency latency_;
};

}  // namespace lagroid
