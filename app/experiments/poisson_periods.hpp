#pragma once
/// Predator and prey over ten thousand periods to a millionth: the library's methods beside those of Boost.odeint, for
/// `lagroid reproduce poisson`.
///
///     const std::string table = periods_table(run_periods(10000), 10000);
///
/// Requires a number of periods above zero. Nothing throws.

#include <string>
#include <vector>

namespace lagroid::app {

/// The cheapest run of one method with an error of 1e-6 at most; not finite where none had it.
struct PeriodsRow {
  std::string library;
  std::string method;
  std::string setting;  ///< its step or its tolerance
  double error = 0;
  double seconds = 0;  ///< of processor, the fastest of three
};
std::vector<PeriodsRow> run_periods(long periods);
std::string periods_table(const std::vector<PeriodsRow>& rows, long periods);
std::string periods_csv(const std::vector<PeriodsRow>& rows);

}  // namespace lagroid::app
