#pragma once
/// Benchmarks grouped for comparison, and their table.

#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace bench {

/// One subject of a group. `reference`: the others' times are given as multiples of this one's.
struct Subject {
  std::string group;
  std::string name;
  std::function<void(benchmark::State&)> run;
  bool reference = false;
};

/// A ratio the project has promised itself: `numerator` over `denominator`, subjects of one group, at most (or, where
/// `at_least`, at least) `bound`.
struct Goal {
  std::string group;
  std::string numerator;
  std::string denominator;
  double bound = 0;
  bool at_least = false;
};

/// Times each subject took: median over the repetitions and spread (quartiles' distance over the median).
struct Measured {
  double median = 0;  ///< ns; of subjects that are counted, not timed, the instructions
  double spread = 0;
  double instructions = 0;  ///< 0 where the machine does not tell
};
using Results = std::map<std::string, Measured>;  ///< by key_of

std::string key_of(const std::string& group, const std::string& name);

/// The subjects whose keys contain `part`, as plain text.
std::vector<Subject> matching(std::vector<Subject> subjects, const std::string& part);

/// Registers the subjects with Google Benchmark and runs them, repetitions interleaved at random.
Results run(const std::vector<Subject>& subjects, int repetitions, double min_time);

/// Markdown: one table per group, and the goals with what was reached. A goal of which nothing was measured is left out
/// unless `every`, where it is said.
std::string table(const std::vector<Subject>& subjects, const Results& results);
std::string goals_table(const std::vector<Goal>& goals, const Results& results, bool every);

/// Runs `steps`, which takes as many as it is told, in the timed loop, and counts the instructions of one where the
/// machine has a counter.
void timed(benchmark::State& state, const std::function<void(long)>& steps, long at_once = 64);

/// What each file contributes.
std::vector<Subject> step_subjects();
std::vector<Goal> step_goals();
std::vector<Subject> lie_newton_subjects();
std::vector<Goal> lie_newton_goals();
std::vector<Subject> boundary_subjects();
std::vector<Goal> boundary_goals();
std::vector<Subject> control_subjects();
std::vector<Goal> control_goals();
/// Optimal control: the iterations of what was timed, and the time of one for each stage.
Results control_counts(const Results& times);
std::string control_table(const Results& results);
std::vector<Subject> recorded_subjects();
std::vector<Subject> scene_subjects();
std::vector<Goal> scene_goals();
std::vector<Subject> scene_gradient_subjects();
std::vector<Subject> pendulum_chain_subjects();
std::vector<Goal> pendulum_chain_goals();
std::vector<Subject> ensemble_subjects();
std::vector<Goal> ensemble_goals();
/// Markdown: instructions and memory of a scene's step without and with each effect. Needs valgrind.
std::string effects_table();
/// Systems that are reduced: the instructions of a step, reduced by the library and by hand. Needs valgrind.
std::vector<std::string> reduction_groups();
Results reduction_counts(const std::vector<std::string>& groups);
std::vector<Goal> reduction_goals(const std::vector<std::string>& groups);
std::string reduction_table(const std::vector<std::string>& groups, const Results& counts);
/// Markdown: what accuracy costs on a chain, by a scene, by hand and by MuJoCo.
std::string chain_accuracy_table();
/// Markdown: seconds to compile the files of bench/user, with the build's own command.
std::string compile_times();

}  // namespace bench
