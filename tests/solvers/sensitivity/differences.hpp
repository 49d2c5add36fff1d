#pragma once
/// Derivatives of a run, of any kind of steps, beside extrapolated differences of runs from other starts.

#include <lagroid/solvers/sensitivity/linearised_motion_of.hpp>
#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/solvers/testing/sensitivity_laws.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace lagroid {

/// Where a run begins, and the parameters that derivatives are by.
template <class Sys> struct RunFrom {
  Sys system;
  State<typename Sys::GroupoidType> start;
  ArrowOf<typename Sys::GroupoidType> configuration;
  std::vector<std::string> names;

  /// Along direction `which` of (displacement, momentum, parameters).
  RunFrom moved(int which, double by) const {
    constexpr int n = Sys::dimension;
    RunFrom to = *this;
    if (which >= 2 * n) {
      const ParameterPlaces places = places_of_parameters(to.system, to.names);
      const_cast<double&>(*places.members[std::size_t(which - 2 * n)]) += by;
      return to;
    }
    const auto [displaced, state] = laws::detail::moved_state(system, start, which, by);
    to.configuration = system.groupoid.compose(configuration, displaced);
    to.start = state;
    return to;
  }
};

inline VariedVector joined(const VariedVector& first, const VariedVector& then) {
  VariedVector out(first.size() + then.size());
  out << first, then;
  return out;
}

/// The configuration and the momentum that is reported.
struct EndOfRun {
  template <class Node> VariedVector operator()(const Node& node) const {
    return joined(node.system.groupoid.coordinates_of_arrow(node.configuration), node.momentum);
  }
};

/// Where its time has derivatives.
struct EndAndTime {
  template <class Node> VariedVector operator()(const Node& node) const {
    const VariedVector end = EndOfRun()(node);
    VariedVector out(end.size() + 1);
    out << end, node.time;
    return out;
  }
};

/// The directions (displacement, momentum, parameters) of a motion that may have more states.
inline Eigen::MatrixXd directions_of_start(const LinearisedMotion& motion, int states) {
  const int parameters = motion.parameters();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(motion.states() + parameters, states + parameters);
  out.topLeftCorner(states, states).setIdentity();
  out.bottomRightCorner(parameters, parameters).setIdentity();
  return out;
}

/// By how much derivatives miss the differences, relative to these: the worst of all directions. `make` makes the
/// linearised motion of a RunFrom, `other` that of one that differs.
template <class Sys, class Make, class Other>
double missed_differences(const RunFrom<Sys>& from, const Make& make, const Other& other, long steps) {
  const auto motion = make(from);
  const Eigen::MatrixXd directions = directions_of_start(*motion, 2 * Sys::dimension);
  const Propagated forward = propagate_forward(*motion, steps, directions);
  EXPECT_TRUE(forward.converged()) << forward.message;
  double missed = 0;
  for (int which = 0; which < int(directions.cols()); ++which) {
    const auto end = [&](double by) -> Eigen::VectorXd {
      const auto moved = other(from.moved(which, by));
      return propagate_forward(*moved, steps, Eigen::MatrixXd::Zero(directions.rows(), 0)).values;
    };
    const Eigen::VectorXd difference = laws::detail::extrapolated_difference(end, 4e-4);
    const double miss = (forward.derivatives.col(which) - difference).norm() / std::max(1.0, difference.norm());
    missed = std::isfinite(miss) ? std::max(missed, miss) : miss;
    if (!std::isfinite(miss)) break;
  }
  return missed;
}

/// Backward is forward, and both are what differences tend to.
template <class Sys, class Make> void expect_exact_derivatives(const RunFrom<Sys>& from, const Make& make, long steps) {
  const auto forwards = make(from), backwards = make(from);
  const Eigen::MatrixXd directions = directions_of_start(*forwards, 2 * Sys::dimension);
  const Propagated forward = propagate_forward(*forwards, steps, directions);
  const Propagated backward = propagate_backward(*backwards, steps, Observed::at_end(), {5});
  ASSERT_TRUE(forward.converged()) << forward.message;
  EXPECT_LT((backward.derivatives * directions - forward.derivatives).norm(), 1e-12 * forward.derivatives.norm());
  EXPECT_LT(missed_differences(from, make, make, steps), 1e-8);
}

}  // namespace lagroid
