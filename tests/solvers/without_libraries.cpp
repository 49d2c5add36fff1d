// What a build without Ceres, TBB, Boost, Spectra and IPOPT says where they are asked for, and that the rest is there:
// made of the files that stand in their place (CMakeLists.txt), and linked to none.
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/control/ipopt/ipopt_control.hpp>
#include <lagroid/solvers/ensemble/tasks.hpp>
#include <lagroid/solvers/learning/train.hpp>
#include <lagroid/solvers/missing_library.hpp>
#include <lagroid/solvers/newton/ceres_lie.hpp>
#include <lagroid/solvers/step/step_methods.hpp>
#include <lagroid/systems/optimisation/extreme_eigenvalues.hpp>
#include <lagroid/systems/reference.hpp>

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

using namespace lagroid;

namespace solvers_without_libraries_tests {
namespace {

/// What is asked of IPOPT, of a problem that is none.
class NoTrajectories final : public TrajectoryChart {
 public:
  const Transcription& transcription() const override { throw std::logic_error("there is none"); }
  void stand_at(const TrajectoryDisplacement&) override {}
  void retraction(long, const double*, Retraction) const override {}
  Range control_range(long, int) const override { return {0, 0}; }
  int inequalities_before_bounds() const override { return 0; }
};

struct Particle : System<Particle, Pair<1>> {
  double h = 0.1;
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
    return (g.target - g.source).squaredNorm() * (0.5 / h);
  }
};

template <class Action> std::string told(const Action& action) {
  try {
    action();
  } catch (const MissingLibrary& error) {
    return error.what();
  }
  return "nothing is missing";
}

TEST(WithoutLibraries, NameThemAndTheRemedy) {
  const Particle system;
  EXPECT_EQ(
      told([&] { make_step_solver(system, StepMethod::ceres); }),
      "the solver \"ceres\" of a step needs Ceres, which this build of lagroid is without; install libceres-dev and "
      "build it again");
  EXPECT_NE(told([] { detail::minimise_by_ceres({}, {}, 1); }).find("install libceres-dev"), std::string::npos);
  EXPECT_NE(told([] { for_each_task(3, 2, [](long) {}); }).find("install libtbb-dev"), std::string::npos);
  EXPECT_NE(told([] { integrate_reference({}, {}, 1.0); }).find("install libboost-dev"), std::string::npos);
  EXPECT_NE(told([] {
              optimisation::extreme_eigenvalues({}, optimisation::SpectrumEnd::both, 2, 24, 1e-4);
            }).find("install libspectra-dev"),
            std::string::npos);
  EXPECT_FALSE(has_ipopt());
  NoTrajectories none;
  EXPECT_NE(told([&] { solve_by_ipopt(none, {}); }).find("install coinor-libipopt-dev"), std::string::npos);
}

TEST(WithoutLibraries, StepsAndTasksAreThere) {
  const Particle system;
  const State<Pair<1>> start{Vector<double, 1>(1), Vector<double, 1>(2)};
  StepSolution<Particle> solution;
  solution.step = {system.groupoid.unit(start.object), {}};
  ASSERT_TRUE(make_step_solver(system, StepMethod::newton)->solve(system, start, solution).converged());
  EXPECT_NEAR(solution.step.arrow.target(0), 1.2, 1e-15);
  long sum = 0;
  for_each_task(4, 0, [&](long i) { sum += i; });
  EXPECT_EQ(sum, 6);
  EXPECT_EQ(available_threads(), 1);
}

}  // namespace
}  // namespace solvers_without_libraries_tests
