#pragma once
/// Reduced systems on Poisson manifolds beside the mechanical systems above them, for `lagroid reproduce poisson`.
///
///     const std::string table = above_table(run_from_above(1000), 1000);
///
/// Throws std::runtime_error for a step that does not converge.

#include <string>
#include <vector>

namespace lagroid::app {

/// One system both ways: the largest difference of the reduced states over the steps, and what a step takes.
struct AboveRow {
  std::string above;
  std::string bracket;
  double largest = 0;
  double microseconds_above = 0;
  double microseconds_bracket = 0;
};
std::vector<AboveRow> run_from_above(long steps);
std::string above_table(const std::vector<AboveRow>& rows, long steps);
std::string above_csv(const std::vector<AboveRow>& rows);

}  // namespace lagroid::app
