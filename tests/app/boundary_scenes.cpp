// What a boundary-value scene says of the solutions it follows, and scenes whose steps vary.
#include <scenes/boundary_value.hpp>
#include <study/run_scene.hpp>

#include "../solvers/boundary/boundary_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include <unistd.h>

using namespace lagroid;
using namespace lagroid::app;

namespace app_boundary_scenes_tests {
namespace {

TEST(ContinuationNote, SolutionsThatMeetAreNotLost) {
  const auto file =
      std::filesystem::temp_directory_path() / ("lagroid_continuation_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(file) << "[parameters]\nlength = 1.0\n[continuation]\nparameter = 'parameters.length'\nfrom = 1.1\n";
  const Section scene = read_scene(file, {});
  std::filesystem::remove(file);
  const auto along = read_continuation(scene);
  ASSERT_TRUE(along.has_value());
  const auto k = known(pendulum(), {Vector<double, 1>(0.4), Vector<double, 1>(0.9)}, 20);
  const auto read = [&](const Section& s) {
    BoundaryScene<Pendulum> out{{k.problem, 20}, k.problem.system.groupoid.unit(k.start.object)};
    out.stage.problem.system.length = s.section("parameters", "").number("length");
    return out;
  };
  const auto solver = make_boundary_solver<Pendulum>();
  const auto start = solver->solve(read_along(scene, *along, 0, read).stage.problem, k.path, false);
  ASSERT_TRUE(start.converged());
  MultistartResult<Pendulum> found;
  found.solutions = {start, start};
  RunResult result;
  EXPECT_EQ(continue_solutions(*solver, scene, *along, read, RunContext{}, found, result), 1);
  EXPECT_EQ(found.solutions.size(), 1U);
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_NE(result.notes[0].find("2 of 2 solution(s) arrived, 1 of them different"), std::string::npos)
      << result.notes[0];
}

RunResult run_example(const std::string& name, std::vector<std::string> overrides) {
  overrides.insert(overrides.end(), {"solver.starts=4", "time.steps=40"});
  return run_scene(read_scene(std::string(LAGROID_EXAMPLES) + "/" + name + ".toml", overrides), {.record = true});
}
const LedgerEntry* entry_of(const RunResult& result, const std::string& name) {
  for (const auto& entry : result.ledger.entries)
    if (entry.name == name) return &entry;
  return nullptr;
}
const Columns* series_of(const RunResult& result, const std::string& name) {
  for (const auto& series : result.trajectory.series)
    if (series.name == name) return &series;
  return nullptr;
}
bool says(const RunResult& result, const std::string& words) {
  return std::any_of(result.notes.begin(), result.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}
std::string refusal(const std::string& name, const std::vector<std::string>& overrides) {
  try {
    run_example(name, overrides);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BoundarySteps, AreAPartOfThePath) {
  const RunResult equal = run_example("unicycle_free_steps", {"time.mode=fixed"});
  const RunResult run = run_example("unicycle_free_steps", {});
  ASSERT_TRUE(run.converged()) << run.message;
  EXPECT_NEAR(run.final.time, 2, 1e-13);
  EXPECT_NEAR(*run.cost, *equal.cost, 0.01 * *equal.cost);
  const LedgerEntry* energy = entry_of(run, "discrete energy E_d");
  ASSERT_NE(energy, nullptr);
  EXPECT_EQ(energy->verdict, "kept");
  EXPECT_LT(energy->relative_drift, 1e-12);
  for (const auto& entry : run.ledger.entries) EXPECT_FALSE(entry.broken()) << entry.name;
  const Columns* steps = series_of(run, "step_size");
  ASSERT_NE(steps, nullptr);
  const auto [least, most] = std::minmax_element(steps->values.begin(), steps->values.end());
  EXPECT_GT(*most / *least, 1.05);
  EXPECT_NEAR(std::accumulate(steps->values.begin(), steps->values.end(), 0.0), 2, 1e-12);
  EXPECT_TRUE(says(run, "the costate of the end time"));
}

TEST(BoundarySteps, ThatDoNotExistAreAnOutcome) {
  const RunResult run = run_example("unicycle_free_steps", {"parameters.map=exp", "solver.starts=1"});
  EXPECT_EQ(run.status, "no_step") << run.message;
  EXPECT_NE(run.message.find("changes its sign along the path"), std::string::npos) << run.message;
  for (const auto& entry : run.ledger.entries) EXPECT_EQ(entry.verdict, "unjudged") << entry.name;
}

TEST(BoundarySteps, ArePrescribedByATimeScale) {
  const RunResult run = run_example("kepler_boundary", {"time.mode=prescribed"});
  ASSERT_TRUE(run.converged()) << run.message;
  EXPECT_NEAR(run.final.time, 2, 1e-13);
  const Columns* multipliers = series_of(run, "step_multiplier");
  ASSERT_NE(multipliers, nullptr);
  EXPECT_EQ(multipliers->values.size(), 40U);
  EXPECT_TRUE(says(run, "by h(g)"));
  const LedgerEntry* turning = entry_of(run, "angular momentum");
  ASSERT_NE(turning, nullptr);
  EXPECT_EQ(turning->verdict, "kept");
}

// The ends of a motion, which is found again, with equal steps and with steps that balance the energy.
TEST(BoundarySteps, OfASystemThatDependsOnTime) {
  const auto scene = [](const std::string& rest) {
    const auto file =
        std::filesystem::temp_directory_path() / ("lagroid_driven_" + std::to_string(::getpid()) + ".toml");
    std::ofstream(file) << "system = 'driven_pendulum'\n[parameters]\ntorque = 0.2\nfrequency = 1.3\n"
                           "[time]\nstart = 0.7\nstep = 0.05\nsteps = 40\n"
                        << rest;
    const RunResult result = run_scene(read_scene(file, {}), {});
    std::filesystem::remove(file);
    return result;
  };
  const RunResult motion = scene("[initial]\nposition = [-0.8]\nmomentum = [0.9]\n");
  ASSERT_TRUE(motion.converged()) << motion.message;
  const std::string ends =
      fmt::format("[boundary]\nstart.position = [-0.8]\nend.position = [{:.17g}]\n[solver]\nstarts = 4\n",
                  motion.final.position[0]);
  const RunResult path = scene(ends);
  ASSERT_TRUE(path.converged()) << path.message;
  EXPECT_NEAR(path.initial.time, 0.7, 1e-15);
  EXPECT_NEAR(path.final.time, 2.7, 1e-13);
  EXPECT_NEAR(path.initial.momentum[0], 0.9, 1e-9);
  EXPECT_NEAR(path.final.momentum[0], motion.final.momentum[0], 1e-9);
  const RunResult varied = scene("mode = 'adaptive'\n" + ends);
  ASSERT_TRUE(varied.converged()) << varied.message;
  EXPECT_NEAR(varied.final.time, 2.7, 1e-13);
  EXPECT_NEAR(varied.initial.momentum[0], 0.9, 1e-2);
  EXPECT_NE(varied.initial.momentum[0], path.initial.momentum[0]);
}

TEST(BoundaryPaths, OneOfThemIsTheResult) {
  const RunResult usual = run_example("plate_ball", {});
  ASSERT_GT(usual.stationary_paths.size(), 2U);
  EXPECT_EQ(*usual.cost, usual.stationary_paths.front().cost);
  const RunResult second = run_example("plate_ball", {"solver.path=2"});
  ASSERT_TRUE(second.converged()) << second.message;
  EXPECT_EQ(*second.cost, usual.stationary_paths[1].cost);
  EXPECT_EQ(second.initial.momentum, usual.stationary_paths[1].momentum);
  EXPECT_TRUE(says(second, "path 2 of ")) << "and not the cheapest";
  EXPECT_NE(refusal("plate_ball", {"solver.path=1000"}).find("solver.path: "), std::string::npos);
  EXPECT_NE(refusal("plate_ball", {"solver.path=1000"}).find(" stationary path(s) were found"), std::string::npos);
}

TEST(BoundarySteps, RefuseWhatTheyDoNotHave) {
  EXPECT_NE(refusal("unicycle", {"time.mode=controlled"}).find("time.mode"), std::string::npos);
  EXPECT_NE(refusal("kepler_boundary", {"time.mode=transformed"}).find("time.mode"), std::string::npos);
  EXPECT_NE(refusal("unicycle", {"time.mode=adaptive", "time.without_root=constant"}).find("without_root"),
            std::string::npos);
}

}  // namespace
}  // namespace app_boundary_scenes_tests
