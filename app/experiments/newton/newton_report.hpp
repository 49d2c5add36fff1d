#pragma once
/// The study of Newton's iteration on Lie groups as text, tables and figures.

#include "newton_on_lie_groups.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::app {

struct NewtonFindings {
  NewtonStudy study;
  std::string command;  ///< that reproduces them
  std::vector<NewtonCell> cells;
  std::vector<IterationTime> times;
  std::vector<IntegratorError> integrators;
};

/// The share of steps that a method solved to |v - h g| <= 1e-13 (1 + h), over all N of the study or one of them.
double solved_share(const NewtonFindings& findings, NewtonExample example, NewtonMethod method,
                    std::optional<int> n = {});

/// report.md with its figures, tables.md, cells.csv, and what the figures are drawn from: all that `folder` can get.
extern const std::vector<const char*> newton_report_files;

/// Writes them whole or not at all; returns the files written. `note` says why pictures are missing, if they are.
std::vector<std::filesystem::path> write_newton_report(const NewtonFindings& findings,
                                                       const std::filesystem::path& folder, std::string& note);

}  // namespace lagroid::app
