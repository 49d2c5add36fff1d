// lagroid bench: framework, hand-written kernels, Ceres and IPOPT in one run; the table, and the page made from it.
#include "comparison.hpp"
#include "pages.hpp"

#include <fmt/format.h>
#include <glog/logging.h>

#include <cstring>
#include <exception>
#include <string>
#include <utility>
#include <vector>

int main(int argc, char** argv) try {
  FLAGS_minloglevel = google::GLOG_FATAL;  // what Ceres says of boundary values that it fails is in the table
  std::string part;
  bool write_page = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--page") == 0) {
      write_page = true;
    } else if (argv[i][0] != '-' && part.empty()) {
      part = argv[i];
    } else {
      fmt::print(stderr, "lagroid bench: \"{}\" is neither --page nor one part of the subjects' names\n", argv[i]);
      return 2;
    }
  }
  if (write_page && !part.empty()) {
    fmt::print(stderr, "lagroid bench: --page takes every measurement; leave out \"{}\"\n", part);
    return 2;
  }
  const auto steps = bench::matching(bench::step_subjects(), part);
  const auto boundary = bench::matching(bench::boundary_subjects(), part);
  const auto groups = bench::matching(bench::lie_newton_subjects(), part);
  const auto scenes = bench::matching(bench::scene_subjects(), part);
  if (part != "effects" && part != "accuracy" && scenes.empty() && steps.empty() && boundary.empty() &&
      groups.empty()) {
    fmt::print(stderr, "lagroid bench: no subject's name contains \"{}\"; docs/performance.md shows the names\n", part);
    return 2;
  }
  bench::Results results = bench::run(steps, 21, 0.02);
  results.merge(bench::run(scenes, 21, 0.02));
  results.merge(bench::run(boundary, 7, 0.02));
  results.merge(bench::run(groups, 21, 0.02));
  std::vector<bench::Goal> goals = bench::step_goals();
  for (auto& goal : bench::boundary_goals()) goals.push_back(std::move(goal));
  for (auto& goal : bench::lie_newton_goals()) goals.push_back(std::move(goal));
  for (auto& goal : bench::scene_goals()) goals.push_back(std::move(goal));
  const std::string step_tables = bench::table(steps, results);
  const std::string boundary_tables = bench::table(boundary, results);
  const std::string scene_tables = bench::table(scenes, results);
  const std::string group_tables = bench::table(groups, results);
  const std::string goals_reached = bench::goals_table(goals, results, /*every=*/part.empty());
  const std::string accuracy = part.empty() || part == "accuracy" ? bench::chain_accuracy_table() : std::string();
  const std::string effects = part.empty() || part == "effects" ? bench::effects_table() : std::string();
  fmt::print("{}{}{}{}\n{}\n{}\n{}", step_tables, scene_tables, boundary_tables, group_tables, accuracy, effects,
             goals_reached);
  if (write_page) {
    std::string page = bench::file_contents(LAGROID_SOURCE "/bench/performance.md.in");
    bench::put(page, "@MACHINE@", bench::machine());
    bench::put(page, "@GOALS@", goals_reached);
    bench::put(page, "@STEPS@", step_tables);
    bench::put(page, "@SCENES@", scene_tables);
    bench::put(page, "@EFFECTS@", effects);
    bench::put(page, "@CHAIN@", accuracy);
    bench::put(page, "@BOUNDARY@", boundary_tables);
    bench::put(page, "@LIE_NEWTON@", group_tables);
    bench::put(page, "@COMPILE@", bench::compile_times());
    bench::write_whole(LAGROID_SOURCE "/docs/performance.md", page);
    fmt::print("\nwritten: docs/performance.md\n");
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "lagroid bench: {}\n", error.what());
  return 1;
}
