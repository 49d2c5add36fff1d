#pragma once
/// What integrators on Poisson manifolds keep, and at which order they converge, measured on the library's systems.

#include "poisson_above.hpp"
#include "poisson_noise.hpp"
#include "poisson_periods.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lagroid::app {

/// One system by one method.
struct PoissonRow {
  std::string system;
  std::string method;
  double order = 0;    ///< from two step sizes, against a finer one; not a number where both errors are rounding
  double defect = 0;   ///< of a step of size 0.1: from a Poisson map, relative; not a number where none is known
  double casimir = 0;  ///< how far the Casimirs go over the run
  double energy_first = 0;
  double energy_last = 0;   ///< how far the energy goes over its first and its last tenth
  double microseconds = 0;  ///< a step
  std::string ended;        ///< why the run ended early; empty where it did not
};

/// Every method of each system, over runs of so many steps of size 0.1. `report(done, all)` is called after each.
std::vector<PoissonRow> run_poisson_study(long steps, const std::function<void(long, long)>& report);

/// Work against error of one system by one method: over two units of time, by steps of one size.
struct PoissonWork {
  std::string system;
  std::string method;
  int steps = 0;         ///< 0 of a method that goes by a tolerance
  double tolerance = 0;  ///< of such a one
  double error = 0;
  double microseconds = 0;  ///< the whole run, the fastest of several
};
/// Of a few systems, every method.
std::vector<PoissonWork> run_poisson_work(const std::function<void(long, long)>& report);

/// Of four mechanical systems, both ways.
std::vector<AboveRow> run_poisson_above();

struct PoissonFindings {
  std::vector<PoissonRow> rows;
  std::vector<PoissonWork> work;
  std::vector<AboveRow> above;
  long period_count = 0;
  std::vector<PeriodsRow> periods;  ///< over so many
  std::vector<NoiseRow> noise;
};

/// Its order, defect and Casimirs in a line; a dash for what has no number.
std::string text_of(const PoissonRow& row);

extern const std::vector<const char*> poisson_report_files;

/// report.md, poisson.csv, work.csv, noise.csv and the figure of work against error.
std::vector<std::filesystem::path> write_poisson_report(const PoissonFindings& found, long steps,
                                                        const std::string& command, const std::filesystem::path& folder,
                                                        std::string& note);

}  // namespace lagroid::app
