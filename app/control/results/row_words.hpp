#pragma once
/// Constraints of a solution by their names: what is violated, what acts where, what repeats what.
///
///     const std::string line = in_words(found, found.report.worst.front());  // "equation of x in stage 17 by 0.03"
///
/// Stages count from one. Nothing throws.

#include "../control_problem.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace lagroid::app {

std::string in_words(const ControlResult& found, const ConstraintViolation& each);
/// A sentence each, which ends with what to do.
std::vector<std::string> repeated_in_words(const ControlResult& found);

/// An inequality with the stages at which it acts.
struct ActingInequality {
  std::string name;
  std::vector<std::array<long, 2>> stages;  ///< first and last
};
/// Those that act somewhere in a solution, several of one name together.
std::vector<ActingInequality> acting_inequalities(const ControlResult& found);

/// The columns of costates, of equations and behind them of conditions on nodes: name, unit, and what they are of.
struct CostateColumn {
  std::string name;
  std::string unit;
  std::string of;
};
std::vector<CostateColumn> costate_columns(const ControlResult& found);

/// A condition on nodes, and the stages that end there.
struct NodeConditions {
  std::string name;
  std::size_t column;          ///< condition_1 is 0
  std::array<long, 2> stages;  ///< first and last
};
std::vector<NodeConditions> node_conditions(const ControlResult& found);

}  // namespace lagroid::app
