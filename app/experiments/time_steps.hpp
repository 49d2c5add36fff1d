#pragma once
/// What accuracy costs with fixed, adaptive and controlled steps, of order two and higher.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lagroid::app {

/// One run of a problem by a method.
struct TimeRun {
  std::string problem;
  std::string method;
  double first_step = 0;
  long steps = 0;
  long evaluations = 0;  ///< of gradients, or of a splitting's Strang steps
  double seconds = 0;    ///< median of three; of long runs, one
  double error = 0;      ///< of the state at the end, against the continuous solution at the time reached
  double energy_error = 0;
  long without_root = 0;
  std::string status;
};

/// A node of the example trajectories.
struct TimeSample {
  std::string problem;
  std::string mode;
  double time;
  double step;
  double energy_error;  ///< of the energy, for adaptive steps of E_d
};

struct TimeFindings {
  std::vector<TimeRun> runs;
  std::vector<TimeSample> samples;
};

/// Kepler's problem with e = 0.9 over ten revolutions, and a pendulum that passes its top. Each method runs with as
/// many (first) steps, each half the last, as `refinements` says. `report(done, all)` is called after each run.
TimeFindings run_time_study(int refinements, const std::function<void(long, long)>& report);

/// How much smaller the error of `method` is than that of fixed steps of order two at the same number of evaluations:
/// the median over its runs that the fixed steps' costs enclose; zero where there are none.
double gain_at_equal_cost(const TimeFindings& findings, const std::string& problem, const std::string& method);

extern const std::vector<const char*> time_report_files;

/// report.md, its figures, and what they are drawn from. `note` says why there are no pictures, where there are none.
std::vector<std::filesystem::path> write_time_report(const TimeFindings& findings, const std::string& command,
                                                     const std::filesystem::path& folder, std::string& note);

}  // namespace lagroid::app
