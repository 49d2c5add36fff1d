// What a boundary-value scene says of the solutions it follows.
#include <scenes/boundary_value.hpp>

#include "../solvers/boundary/boundary_cases.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <unistd.h>

using namespace lagroid;
using namespace lagroid::app;

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

}  // namespace
