// A system of one's own, run from C++: its ledger, its files, its resumption.
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/run.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <tuple>

using namespace lagroid;

namespace fs = std::filesystem;

namespace run_own_run_tests {
namespace {

/// A mass that hangs on a spring from the origin of the plane. Its Lagrangian has the step as an argument.
struct Spring : System<Spring, Pair<2>> {
  double h = 0.05;
  double stiffness = 1;
  double mass = 1;  // which it does not declare
  static auto parameters() { return std::tuple(parameter("stiffness", &Spring::stiffness, "N/m", "of the spring")); }
  template <class S, class T> auto lagrangian(const PairArrow<S, 2>& g, const T& step) const {
    const Vector<S, 2> v = g.target - g.source;
    const Vector<S, 2> q = (g.target + g.source) * 0.5;
    return v.squaredNorm() * (0.5 * mass) / step - q.squaredNorm() * (0.5 * stiffness) * step;
  }
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const { return lagrangian(g, h); }
  std::vector<Symmetry<Spring>> symmetries() const {
    return {{"angular momentum", [](const Vector<double, 2>& q) { return Vector<double, 2>(-q(1), q(0)); }}};
  }
};

const State<Pair<2>> start{{1, 0}, {0.2, 0.7}};

const LedgerEntry* entry_of(const RunResult& result, const std::string& name) {
  const auto& all = result.ledger.entries;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& e) { return e.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class OwnRun : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              (std::string("own_run_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_F(OwnRun, HasDeclaredSymmetriesAndTheDiscreteEnergyInItsLedger) {
  const RunResult result = run(Spring{}, start, {.steps = 2000, .name = "spring"});
  ASSERT_TRUE(result.converged()) << result.message;
  EXPECT_EQ(result.steps, 2000);
  const LedgerEntry* momentum = entry_of(result, "angular momentum");
  ASSERT_NE(momentum, nullptr);
  EXPECT_EQ(momentum->verdict, "kept");
  EXPECT_NEAR(momentum->initial.at(0), 0.7, 1e-15);
  const LedgerEntry* energy = entry_of(result, "discrete energy E_d");
  ASSERT_NE(energy, nullptr);
  EXPECT_EQ(energy->verdict, "bounded");
  EXPECT_LT(energy->bound, energy->initial.at(0));  // it would notice another energy
  EXPECT_NEAR(energy->initial.at(0), 0.5 * (0.04 + 0.49) + 0.5, 1e-3);
  EXPECT_NE(text_report(result).find("angular momentum"), std::string::npos);
}

/// Says that it keeps what it does not.
struct Boastful : Spring {
  std::vector<Quantity<Boastful>> quantities() const {
    return {{"abscissa", {"x"}, Promise::conserved, false, [](const TrajectoryPoint<Boastful>& p, double* out) {
               *out = p.state.object(0);
             }}};
  }
};
TEST_F(OwnRun, ABrokenPromiseIsTold) {
  const RunResult result = run(Boastful{}, start, {.steps = 100});
  const LedgerEntry* abscissa = entry_of(result, "abscissa");
  ASSERT_NE(abscissa, nullptr);
  EXPECT_TRUE(abscissa->broken());
}

TEST_F(OwnRun, RecordsTheNodesAskedForAndTheLast) {
  const RunResult result = run(Spring{}, start, {.steps = 25, .every = 10});
  const auto& time = result.trajectory.time;
  ASSERT_EQ(time.size(), 4u);
  EXPECT_NEAR(time[1], 0.5, 1e-15);
  EXPECT_NEAR(time[3], 1.25, 1e-15);
  EXPECT_EQ(result.trajectory.series.at(0).components, (std::vector<std::string>{"q1", "q2"}));
}

/// A free body: the configuration, an attitude, is followed from the one given.
struct Body : System<Body, SO3> {
  double h = 0.1;
  template <class S> S lagrangian(const Matrix<S, 3, 3>& g) const {
    const Vector<S, 3> w = groupoid.tau_inverse(g);
    return (w(0) * w(0) * 3.0 + w(1) * w(1) * 2.0 + w(2) * w(2)) * (0.5 / h);
  }
};
TEST_F(OwnRun, FollowsTheConfiguration) {
  const Matrix<double, 3, 3> attitude = SO3::exp(Vector<double, 3>(0.3, -0.2, 0.5));
  const RunResult result = run(Body{}, {{}, {0.3, 1.5, 0.4}}, {.steps = 100, .configuration = attitude});
  ASSERT_TRUE(result.converged());
  const auto& series = result.trajectory.series;
  const auto found =
      std::find_if(series.begin(), series.end(), [](const auto& s) { return s.name == "configuration"; });
  ASSERT_NE(found, series.end());
  const Eigen::Map<const Matrix<double, 3, 3>> first(found->values.data());
  const Eigen::Map<const Matrix<double, 3, 3>> last(found->values.data() + 900);
  EXPECT_EQ(first, attitude);
  const Vector<double, 3> before = attitude * Vector<double, 3>(0.3, 1.5, 0.4);
  const Vector<double, 3> after = last * Eigen::Map<const Vector<double, 3>>(result.final.momentum.data());
  EXPECT_LT((after - before).norm(), 1e-13);
}

TEST_F(OwnRun, WritesWhatViewAndPlotRead) {
  const RunResult result = run(Spring{}, start, {.steps = 200, .folder = folder_});
  EXPECT_TRUE(result.output_error.empty()) << result.output_error;
  for (const char* file : {"trajectory.csv", "trajectory.h5", "summary.json", "summary.txt", "plot.gp"})
    EXPECT_TRUE(fs::exists(folder_ / file)) << file;
  EXPECT_TRUE(text_of(folder_ / "trajectory.csv").starts_with("t,q1,q2,mu1,mu2,")) << folder_;
}

TEST_F(OwnRun, IsTakenUpWithTheSameBits) {
  const fs::path whole = folder_ / "whole";
  const fs::path parts = folder_ / "parts";
  run(Spring{}, start, {.steps = 300, .folder = whole});
  run(Spring{}, start, {.steps = 120, .folder = parts});
  const RunResult result = run(Spring{}, start, {.steps = 300, .folder = parts, .resume = true});
  EXPECT_EQ(result.steps, 300);
  EXPECT_EQ(text_of(whole / "trajectory.csv"), text_of(parts / "trajectory.csv"));
}

TEST_F(OwnRun, OfAnotherStartIsNotTakenUpNorWrittenOver) {
  run(Spring{}, start, {.steps = 20, .folder = folder_});
  const State<Pair<2>> other{{1, 0}, {0.2, 0.71}};
  const auto before = text_of(folder_ / "trajectory.csv");
  EXPECT_THROW(run(Spring{}, other, {.steps = 40, .folder = folder_, .resume = true}), RunError);
  EXPECT_THROW(run(Spring{}, other, {.steps = 40, .folder = folder_}), FolderRefused);
  EXPECT_EQ(text_of(folder_ / "trajectory.csv"), before);
}

TEST_F(OwnRun, OfOtherParametersIsNotTakenUpNorWrittenOver) {
  run(Spring{}, start, {.steps = 20, .folder = folder_});
  const auto before = text_of(folder_ / "trajectory.csv");
  Spring stiffer;
  stiffer.stiffness = 4;
  Spring heavier;
  heavier.mass = 2;
  for (const Spring& other : {stiffer, heavier}) {
    EXPECT_THROW(run(other, start, {.steps = 40, .folder = folder_, .resume = true}), RunError);
    EXPECT_THROW(run(other, start, {.steps = 40, .folder = folder_}), FolderRefused);
  }
  EXPECT_THROW(run(Spring{}, start, {.steps = 40, .folder = folder_, .resume = true, .every = 7}), RunError);
  EXPECT_EQ(text_of(folder_ / "trajectory.csv"), before);
}

TEST_F(OwnRun, TheDiscreteEnergyNoticesAnotherSpring) {
  // What a run of other parameters would do to it is more than its bound allows.
  const RunResult result = run(Spring{}, start, {.steps = 20});
  Spring stiffer;
  stiffer.stiffness = 4;
  const RunResult other = run(stiffer, start, {.steps = 20});
  const auto *mine = entry_of(result, "discrete energy E_d"), *its = entry_of(other, "discrete energy E_d");
  EXPECT_GT(std::abs(its->initial.at(0) - mine->initial.at(0)), mine->bound);
}

TEST_F(OwnRun, AStartThatIsNoNumberIsRefused) {
  const State<Pair<2>> nowhere{{std::numeric_limits<double>::quiet_NaN(), 0}, {0, 1}};
  EXPECT_THROW(run(Spring{}, nowhere, {.steps = 10}), std::invalid_argument);
}

TEST_F(OwnRun, AStepThatFailsEndsItWithWhatWasComputed) {
  Spring too_stiff;  // its force overflows
  too_stiff.stiffness = 1e308;
  const RunResult result = run(too_stiff, {{1e10, 0}, {0, 1}}, {.steps = 10});
  EXPECT_FALSE(result.converged());
  EXPECT_EQ(result.steps, 0);
  EXPECT_NE(result.message.find("step 1"), std::string::npos) << result.message;
}

TEST_F(OwnRun, OptionsThatCountNothingAreRefused) {
  EXPECT_THROW(run(Spring{}, start, {.steps = -1}), std::invalid_argument);
  EXPECT_THROW(run(Spring{}, start, {.every = 0}), std::invalid_argument);
  EXPECT_THROW(run(Spring{}, start, {.name = "two\nlines"}), std::invalid_argument);
  EXPECT_THROW(run(Spring{}, start, {.resume = true}), RunError);
}

}  // namespace
}  // namespace run_own_run_tests
