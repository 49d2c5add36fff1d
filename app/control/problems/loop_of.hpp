#pragma once
/// The loop of a scene: its problem, solved anew at every sample from the state that the motion has come to.
///
///     LoopOf<SwingUp> loop(task, scene, plan);
///     loop.advance(state);
///
/// Throws nothing: `report` says how a sample ended.

#include "../control_scene.hpp"
#include "../scene_loop.hpp"
#include "states_of_problem.hpp"

#include <lagroid/solvers/control/control_loop.hpp>
#include <lagroid/solvers/control/control_search.hpp>

#include <span>
#include <vector>

namespace lagroid::app {

template <class Sys> class LoopOf final : public SceneLoop {
 public:
  using States = FlowStates<typename Sys::GroupoidType>;
  using State = typename States::State;

  LoopOf(const ControlTask<Sys>& task, const ControlScene& scene, const ControlSolution<Sys>& plan)
      : system_(task.system),
        end_(Eigen::Map<const State>(scene.end.data())),
        state_(Eigen::Map<const State>(scene.start.data())),
        usable_(scene.loop.value_or(LoopScene()).usable),
        loop_(task, plan, options(scene)),
        report_(plan.report) {
    if (report_.converged()) report_ = loop_.begin();
  }
  const ControlReport& report() const override { return report_; }
  void advance(std::span<const double> state) override {
    state_ = Eigen::Map<const State>(state.data());
    report_ = loop_.follow(arrow_between(system_, state_, end_), usable_);
  }
  std::vector<double> control() const override {
    const Vector<double, Sys::controls> u = loop_.control();
    return {u.begin(), u.end()};
  }
  double cost() const override { return system_.cost(plan().arrows.front(), loop_.control(), plan().step()); }
  std::vector<double> predicted() const override {
    const State next = States::reached(state_, plan().arrows.front());
    return {next.begin(), next.end()};
  }
  double step() const override { return plan().step(); }
  long stages() const override { return long(plan().arrows.size()); }
  long restarts() const override { return loop_.restarts(); }
  const Latency& latency() const override { return loop_.latency(); }

 private:
  static ControlLoopOptions options(const ControlScene& scene) {
    const LoopScene loop = scene.loop.value_or(LoopScene());
    ControlLoopOptions out{.iterations = loop.iterations, .solver = scene.search.solver};
    out.solver.tolerance = loop.tolerance;
    return out;
  }
  const ControlTrajectory<Sys>& plan() const { return loop_.plan(); }

  Sys system_;
  State end_;
  State state_;
  double usable_;
  ControlLoop<Sys> loop_;
  ControlReport report_;
};

}  // namespace lagroid::app
