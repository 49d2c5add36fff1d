// lagroid bench: framework, hand-written kernels, Ceres and IPOPT in one run; the table, and the page made from it.
#include "comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

namespace {

std::string file_contents(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot read " + path);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

void put(std::string& page, const std::string& mark, const std::string& text) {
  const auto at = page.find(mark);
  if (at == std::string::npos) throw std::runtime_error("the page's template lacks " + mark);
  page.replace(at, mark.size(), text);
}

std::string machine() {
  std::ifstream cpu("/proc/cpuinfo");
  std::string line;
  while (std::getline(cpu, line))
    if (line.starts_with("model name")) break;
  const auto colon = line.find(": ");
  char date[32] = "";
  const std::time_t now = std::time(nullptr);
  std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
  return fmt::format("{}, {}, -march={}, {}", colon == std::string::npos ? "unknown processor" : line.substr(colon + 2),
                     LAGROID_COMPILER, LAGROID_ARCH, date);
}

struct Part {
  std::vector<bench::Subject> subjects;
  std::vector<bench::Goal> goals;
  bench::Results results;
};

Part measured(std::vector<bench::Subject> subjects, std::vector<bench::Goal> goals, int repetitions, double min_time,
              const std::string& filter) {
  auto results = bench::run(subjects, repetitions, min_time, filter);
  return {std::move(subjects), std::move(goals), std::move(results)};
}

}  // namespace

int main(int argc, char** argv) try {
  std::string filter;
  bool write_page = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--page") == 0) {
      write_page = true;
    } else if (argv[i][0] != '-' && filter.empty()) {
      filter = argv[i];
    } else {
      fmt::print(stderr, "lagroid bench: \"{}\" is neither --page nor a regular expression for the names\n", argv[i]);
      return 2;
    }
  }
  if (write_page && !filter.empty()) {
    fmt::print(stderr, "lagroid bench: --page takes every measurement; leave out \"{}\"\n", filter);
    return 2;
  }
  const Part steps = measured(bench::step_subjects(), bench::step_goals(), 21, 0.02, filter);
  const Part boundary = measured(bench::boundary_subjects(), bench::boundary_goals(), 7, 0.02, filter);
  const std::string step_tables = bench::table(steps.subjects, steps.results);
  const std::string boundary_tables = bench::table(boundary.subjects, boundary.results);
  std::vector<bench::Goal> goals = steps.goals;
  goals.insert(goals.end(), boundary.goals.begin(), boundary.goals.end());
  bench::Results all = steps.results;
  all.insert(boundary.results.begin(), boundary.results.end());
  const std::string goals_reached = bench::goals_table(goals, all);
  fmt::print("{}{}\n{}", step_tables, boundary_tables, goals_reached);
  if (write_page) {
    std::string page = file_contents(LAGROID_SOURCE "/bench/performance.md.in");
    put(page, "@MACHINE@", machine());
    put(page, "@GOALS@", goals_reached);
    put(page, "@STEPS@", step_tables);
    put(page, "@BOUNDARY@", boundary_tables);
    put(page, "@COMPILE@", bench::compile_times());
    std::ofstream(LAGROID_SOURCE "/docs/performance.md") << page;
    fmt::print("\nwritten: docs/performance.md\n");
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "lagroid bench: {}\n", error.what());
  return 1;
}
