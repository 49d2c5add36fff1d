#pragma once
/// The derivatives that `lagroid gradient` was asked for, and how they are printed.
///
///     const GradientTable table = differentiate(subject, {"final.position"}, {"parameters.strength"}, true);
///     print(text_of(table));
///
/// Errors: GradientRefused, one line, for what has no derivative or no such name.

#include "gradient_subject.hpp"

#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::app {

class GradientRefused : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct GradientTable {
  std::string system;
  long steps = 0;
  std::vector<std::string> rows;     ///< final.x, node.10.px, integral.x
  std::vector<std::string> columns;  ///< initial.x, parameters.strength
  Eigen::VectorXd values;            ///< of the rows
  Eigen::MatrixXd derivatives;
  double growth = 1;
  double digits_left = 0;
  long steps_solved = 0;
  long states_kept = 0;
  bool checked = false;
  Eigen::MatrixXd differences;  ///< extrapolated, of the program
  double digits_agreed = 0;     ///< the fewest, to the largest of each row
  std::string failure;          ///< of a run that ended early
};

GradientTable differentiate(const GradientSubject& subject, const std::vector<std::string>& of,
                            const std::vector<std::string>& by, bool check);

std::string text_of(const GradientTable& table);
std::string json_of(const GradientTable& table);

}  // namespace lagroid::app
