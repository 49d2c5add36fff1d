#pragma once
/// What was found, as tables, figures and the page docs/peers.md.

#include "study.hpp"

#include <string>
#include <vector>

namespace peers {

/// A problem and its study up to each of its times.
struct Findings {
  Problem problem;
  std::vector<Study> studies;
};

/// Markdown: the tables of one problem.
std::string section(const Findings& found);
/// Markdown: every ratio that falls short of what was wanted.
std::string summary(const std::vector<Findings>& all);
/// Writes docs/peers.md from bench/peers/peers.md.in, docs/peers/runs.csv and the figures.
void write_page(const std::vector<Findings>& all);

}  // namespace peers
