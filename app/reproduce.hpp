#pragma once
/// `lagroid reproduce`: the experiments of a paper, as report, tables, CSV and figures.

#include "command.hpp"

#include "reproductions/newton_on_lie_groups.hpp"

namespace lagroid::app {

struct ReproduceOptions {
  NewtonStudy newton;
  std::string newton_out = "out/newton-on-lie-groups";
};

/// The subcommands of `reproduce`, one for each paper.
void add_reproductions(CLI::App& command, ReproduceOptions& options, bool& json);

/// Carries out the one that was named; returns the exit code.
int reproduce(const ReproduceOptions& options, bool json);

}  // namespace lagroid::app
