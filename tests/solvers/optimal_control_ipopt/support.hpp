// What tests of optimal control by IPOPT share.
#pragma once

#include <lagroid/solvers/control/control_search.hpp>
#include <lagroid/solvers/control/ipopt/ipopt_control.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace lagroid::ipopt_tests {

/// The largest difference of arrows, along their fibres, of controls and of durations.
template <class Sys>
double distance(const Sys& system, const ControlTrajectory<Sys>& a, const ControlTrajectory<Sys>& b) {
  const auto& groupoid = system.groupoid;
  double most = std::abs(a.duration() - b.duration());
  for (std::size_t k = 0; k < a.arrows.size(); ++k) {
    const auto difference = (groupoid.tau_inverse(a.arrows[k]) - groupoid.tau_inverse(b.arrows[k])).eval();
    most = std::max({most, difference.cwiseAbs().maxCoeff(), (a.controls[k] - b.controls[k]).cwiseAbs().maxCoeff()});
  }
  return most;
}

/// From the first two starts of a search: where both find a minimum of the same cost, to 1e-8, it is the same
/// trajectory, and from one start at least they do. One of them may fail, or they may find different minima.
template <class Sys> void expect_agreement(const std::string& name, const ControlTask<Sys>& task) {
  constexpr long stages = 40;
  int agreed = 0;
  for (int i = 0; i < 2; ++i) {
    const ControlTrajectory<Sys> start = control_guess(task, stages, i);
    const ControlSolution<Sys> ours = solve_control(task, start);
    const ControlSolution<Sys> theirs = solve_control_by_ipopt(task, start);
    if (!ours.report.converged() || !theirs.report.converged()) continue;
    EXPECT_LE(theirs.report.stationarity, 1e-7) << name << i;
    EXPECT_LE(theirs.report.violation, 1e-9) << name << i;
    EXPECT_LE(theirs.report.complementarity, 1e-7) << name << i;
    EXPECT_EQ(theirs.report.is_strict_minimum(), ours.report.is_strict_minimum()) << name << i;
    const double size = std::max(1.0, std::abs(ours.report.cost));
    if (std::abs(ours.report.cost - theirs.report.cost) > 1e-8 * size) continue;
    ++agreed;
    EXPECT_LE(distance(task.system, ours.trajectory, theirs.trajectory), 1e-6) << name << i;
  }
  EXPECT_GE(agreed, 1) << name;
}

template <class Sys>
ControlTask<Sys> task_on(typename FlowStates<typename Sys::GroupoidType>::State start,
                         typename FlowStates<typename Sys::GroupoidType>::State end, double duration) {
  return {{}, FlowStates<typename Sys::GroupoidType>::arrow(start, end), duration};
}

}  // namespace lagroid::ipopt_tests
