// lagroid bench: framework, hand-written kernels, Ceres and IPOPT in one run; the table, and the page made from it.
#include "report/comparison.hpp"
#include "report/pages.hpp"

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
  struct Chapter {
    const char* mark;  // in the page's template
    std::vector<bench::Subject> subjects;
    std::vector<bench::Goal> goals;
    int repetitions;
    std::string tables = {};
  };
  std::vector<Chapter> chapters{
      {"@STEPS@", bench::step_subjects(), bench::step_goals(), 21},
      {"@RUNS@", bench::recorded_subjects(), {}, 7},
      {"@SCENES@", bench::scene_subjects(), bench::scene_goals(), 21},
      {"@SCENE_GRADIENTS@", bench::scene_gradient_subjects(), {}, 5},
      {"@PENDULUM_CHAINS@", bench::pendulum_chain_subjects(), bench::pendulum_chain_goals(), 21},
      {"@ENSEMBLES@", bench::ensemble_subjects(), bench::ensemble_goals(), 11},
      {"@BOUNDARY@", bench::boundary_subjects(), bench::boundary_goals(), 7},
      {"@CONTROL@", bench::control_subjects(), bench::control_goals(), 5},
      {"@LIE_NEWTON@", bench::lie_newton_subjects(), bench::lie_newton_goals(), 21},
  };
  bool any = part == "effects" || part == "accuracy" || part == "reduction";
  for (auto& chapter : chapters) {
    chapter.subjects = bench::matching(std::move(chapter.subjects), part);
    any = any || !chapter.subjects.empty();
  }
  if (!any) {
    fmt::print(stderr, "lagroid bench: no subject's name contains \"{}\"; docs/performance.md shows the names\n", part);
    return 2;
  }
  bench::Results results;
  std::vector<bench::Goal> goals;
  std::string tables;
  for (auto& chapter : chapters) {
    results.merge(bench::run(chapter.subjects, chapter.repetitions, 0.02));
    goals.insert(goals.end(), chapter.goals.begin(), chapter.goals.end());
    chapter.tables = bench::table(chapter.subjects, results);
    tables += chapter.tables;
  }
  results.merge(bench::control_counts(results));
  const std::string iterations = bench::control_table(results);
  std::string reductions;
  if (part.empty() || part == "reduction") {
    const auto groups = bench::reduction_groups();
    results.merge(bench::reduction_counts(groups));
    reductions = bench::reduction_table(groups, results);
    for (auto& goal : bench::reduction_goals(groups)) goals.push_back(std::move(goal));
  }
  const std::string goals_reached = bench::goals_table(goals, results, /*every=*/part.empty());
  const std::string accuracy = part.empty() || part == "accuracy" ? bench::chain_accuracy_table() : std::string();
  const std::string effects = part.empty() || part == "effects" ? bench::effects_table() : std::string();
  fmt::print("{}\n{}\n{}\n{}\n{}\n{}", tables, iterations, accuracy, effects, reductions, goals_reached);
  if (write_page) {
    std::string page = bench::file_contents(LAGROID_SOURCE "/bench/performance.md.in");
    bench::put(page, "@MACHINE@", bench::machine());
    bench::put(page, "@GOALS@", goals_reached);
    for (const auto& chapter : chapters) bench::put(page, chapter.mark, chapter.tables);
    bench::put(page, "@CONTROL_ITERATIONS@", iterations);
    bench::put(page, "@EFFECTS@", effects);
    bench::put(page, "@REDUCTIONS@", reductions);
    bench::put(page, "@CHAIN@", accuracy);
    bench::put(page, "@COMPILE@", bench::compile_times());
    bench::write_whole(LAGROID_SOURCE "/docs/performance.md", page);
    fmt::print("\nwritten: docs/performance.md\n");
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "lagroid bench: {}\n", error.what());
  return 1;
}
