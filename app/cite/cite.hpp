#pragma once
/// `lagroid cite`: how to cite the program and the papers behind a run.

#include "../command/parser.hpp"

#include <string>
#include <vector>

namespace lagroid::app {

struct CiteOptions {
  std::string subject;  ///< a scene, a sweep, or the folder of a run or of what was learned; empty: all
  std::vector<std::string> overrides;
  bool bibtex = false;
  bool json = false;
  bool cff = false;
};

void add_cite_options(CLI::App& command, CiteOptions& options);

/// Prints the citations. Throws SceneError. Returns the exit code.
int cite(const CiteOptions& options);

}  // namespace lagroid::app
