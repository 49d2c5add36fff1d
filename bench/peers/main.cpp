// lagroid_peers: our methods and those of other software on equal problems, by equal measures of error.
#include "page.hpp"
#include "problems/problem.hpp"
#include "study.hpp"

#include <fmt/format.h>
#include <glog/logging.h>

#include <cstring>
#include <exception>
#include <string>
#include <vector>

int main(int argc, char** argv) try {
  FLAGS_minloglevel = google::GLOG_FATAL;
  std::string only;
  bool write_page = false;
  bool brief = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--page") == 0) {
      write_page = true;
    } else if (std::strcmp(argv[i], "--brief") == 0) {
      brief = true;
    } else if (argv[i][0] != '-' && only.empty()) {
      only = argv[i];
    } else {
      fmt::print(stderr, "lagroid_peers: \"{}\" is neither --page, --brief nor the name of one problem\n", argv[i]);
      return 2;
    }
  }
  if (write_page && !only.empty()) {
    fmt::print(stderr, "lagroid_peers: --page takes every problem; leave out \"{}\"\n", only);
    return 2;
  }
  std::vector<peers::Findings> findings;
  std::string names;
  for (const auto make :
       {peers::rigid_body, peers::kepler, peers::pendulum, peers::spherical_pendulum, peers::top, peers::chain}) {
    peers::Problem problem = make();
    names += " " + problem.name;
    if (!only.empty() && only != problem.name) continue;
    peers::Findings found{std::move(problem), {}};
    for (const double end : found.problem.ends) {
      fmt::print(stderr, "{}, T = {:g} ", found.problem.name, end);
      found.studies.push_back(peers::study(found.problem, end, peers::effort_for(end, brief)));
    }
    fmt::print("{}\n", peers::section(found));
    findings.push_back(std::move(found));
  }
  if (findings.empty()) {
    fmt::print(stderr, "lagroid_peers: no problem is called \"{}\"; there are:{}\n", only, names);
    return 2;
  }
  fmt::print("{}\n", peers::summary(findings));
  if (write_page) {
    peers::write_page(findings);
    fmt::print("\nwritten: docs/peers.md, docs/audit.md and docs/peers/\n");
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "lagroid_peers: {}\n", error.what());
  return 1;
}
