#pragma once
/// The report of `reproduce accelerated-optimization`.

#include "accelerated_optimisation.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid::app {

extern const std::vector<const char*> accelerated_report_files;

/// report.md, its figures, and what they are drawn from. `note` says why there are no pictures, where there are none.
std::vector<std::filesystem::path> write_accelerated_report(const AcceleratedFindings& findings,
                                                            const std::string& command,
                                                            const std::filesystem::path& folder, std::string& note);

}  // namespace lagroid::app
