#pragma once
/// What `event_sensitivities` finds: how the times of events, what is observed there and the end of a run depend on its
/// start, 2 n numbers (displacement, momentum), and on parameters.
///
///     const EventSensitivities fall = event_sensitivities(bob, start, {floor}, {.steps = 100});
///     if (fall.converged()) use(fall.happened[0].by_start);
///
/// Requires nothing; nothing throws.

#include <lagroid/solvers/status.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace lagroid {

/// Where the time of an event has no derivative, or a part of a step none of its own.
namespace event_limits {
inline constexpr double grazing = 1e-8;   ///< a rate, of its terms: the function only touches zero
inline constexpr double together = 1e-9;  ///< between two events, of a step: it is not known which is first
/// Of a part, of a step: the derivative of a shorter one is that of momenta which are differences of places over its
/// duration.
inline constexpr double shortest = 5e-7;
}  // namespace event_limits

struct EventSensitivities {
  SolveStatus status = SolveStatus::converged;
  std::string message;
  std::vector<std::string> parameters;
  /// An event that happened, and how its time depends on the start, 2 n numbers (displacement, momentum), and on the
  /// parameters.
  struct Happened {
    std::size_t event;
    double time;
    Eigen::RowVectorXd by_start;
    Eigen::RowVectorXd by_parameters;
    Eigen::VectorXd observed;           ///< before a kick; none unless there is a function to observe
    Eigen::MatrixXd observed_by_start;  ///< a row for each of them
    Eigen::MatrixXd observed_by_parameters;
  };
  std::vector<Happened> happened;
  std::vector<std::string> notes;  ///< of functions that are undefined, jump, only touch zero, or are zero at the start
  /// An event whose function is zero at the start in its direction, and what that depends on there. How many times one
  /// that only records has happened has no derivative along what moves it off zero.
  struct Begun {
    std::size_t event;
    Eigen::RowVectorXd by_start;
    Eigen::RowVectorXd by_parameters;
  };
  std::vector<Begun> begun;
  long steps = 0;                 ///< that were made whole
  bool is_stopped = false;        ///< by an event, which is the last that happened
  double growth = 1;              ///< the largest factor by which directions of the start grew on the way
  double time = 0;                ///< of the end: of the last node, or of the event that stopped the run
  Eigen::MatrixXd by_start;       ///< of (displacement, momentum) at the end, as those of `sensitivities`
  Eigen::MatrixXd by_parameters;  ///< a column for each
  Eigen::VectorXd observed;       ///< at the end, or at the node that was asked for
  Eigen::MatrixXd observed_by_start;
  Eigen::MatrixXd observed_by_parameters;

  bool converged() const { return status == SolveStatus::converged; }
};

}  // namespace lagroid
