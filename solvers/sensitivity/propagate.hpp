#pragma once
/// Derivatives along a motion: forward, dx_{k+1} = A_k dx_k, or backward, y_k = A_k^T y_{k+1}, A_k the linearised step.
///
/// Forward costs by the number of directions; backward by the number of functions, whatever the number of parameters,
/// and wants the steps in reverse. They are computed again from states kept on the way: with s states, a motion of
/// N <= binomial(s + r, s) steps is repeated r times, and once more where gradients cannot be taken back over a step
/// between its two nodes (`LinearisedMotion::take_back`).
///
///     const Propagated end = propagate_forward(motion, 1000, directions);
///     const Propagated start = propagate_backward(motion, 1000, Observed::at_end(), {.states = 20});
///
/// Requires a motion at its start. A step that fails ends it, with that step's status and a message.
///
/// Errors: std::invalid_argument for a node that the run does not have.
///
/// Source: Griewank and Walther, Algorithm 799, ACM Trans. Math. Softw. 26, 2000 (binomial checkpoints).

#include <lagroid/solvers/sensitivity/linearised_motion.hpp>

#include <string>

namespace lagroid {

/// At which nodes functions are observed, and what becomes of them.
struct Observed {
  enum class Kind { at_node, integral };
  Kind kind = Kind::at_node;
  long node = -1;  ///< of at_node; -1: the last

  static Observed at_end() { return {}; }
  static Observed at_node(long node) { return {Kind::at_node, node}; }
  /// Over the time of the run, by the trapezoidal rule on its nodes.
  static Observed integral() { return {Kind::integral, -1}; }
};

/// What the backward direction may keep on the way: a number of states, or 0 for 2 sqrt(N). The two ends of the step
/// that it is at are beside them.
struct StateBudget {
  long states = 0;
  /// Of the order of log N, at which a motion of N steps is repeated some four times.
  static StateBudget logarithmic(long steps);
};

struct Propagated {
  SolveStatus status = SolveStatus::converged;
  std::string message;     ///< of a motion that ended early
  Eigen::VectorXd values;  ///< of the functions
  /// Forward: derivatives of the functions along the directions. Backward: by (v, mu, theta) of the start. A row for
  /// each function.
  Eigen::MatrixXd derivatives;
  Eigen::MatrixXd end;  ///< forward: the directions at the end, states and below them parameters
  /// The largest factor, on the way, by which errors of the start grew (growth/growth.hpp), whatever parameters there
  /// are; where forward directions are all of parameters, by which these did.
  double growth = 1;
  long steps_solved = 0;  ///< in all, those computed again too
  long states_kept = 0;   ///< at most, at a time

  bool converged() const { return status == SolveStatus::converged; }
  /// Of the derivatives, by the growth: what rounding at the start becomes.
  double digits_left() const;
};

/// The directions start as columns of (v, mu, theta); without any, values are observed and no step is linearised.
Propagated propagate_forward(LinearisedMotion& motion, long steps, const Eigen::MatrixXd& directions,
                             const Observed& observed = Observed::at_end());
Propagated propagate_backward(LinearisedMotion& motion, long steps, const Observed& observed = Observed::at_end(),
                              StateBudget budget = {});

}  // namespace lagroid
