// Batches as scalars, and ensembles made of them: each lane by itself, whatever its neighbours, threads and pauses.
#include <lagroid/solvers/testing/ensemble_laws.hpp>
#include <lagroid/systems/ensembles.hpp>

#include "../support/allocation_counter.hpp"
#include "../support/broken.hpp"
#include "../support/draws.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace solvers_ensemble_tests {
namespace {

using namespace lagroid;
using B = Batch<>;

/// Lanes from -10^k to 10^k for several k, and special numbers between them.
std::vector<double> arguments() {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> out{0, -0.0, 1e-300, 0.5, 1, std::acos(-1.0) / 4, 2, std::acos(-1.0), 4, 1e6, 1.1e6, 1e15, -1e22};
  for (double size = 1e-8; size < 1e8; size *= 10)
    for (int i = 0; i < 200; ++i) out.push_back(size * uniform(random));
  while (out.size() % B::lanes != 0) out.push_back(0.1);
  return out;
}

/// The largest error of `batched` in units in the last place of `one`'s largest possible value, and whether any lane
/// depends on its neighbours.
template <class Batched, class One>
void expect_lanes(const Batched& batched, const One& one, std::vector<double> x, double tolerance) {
  for (std::size_t i = 0; i < x.size(); i += B::lanes) {
    const B together = batched(B::load(&x[i]));
    for (int lane = 0; lane < B::lanes; ++lane) {
      const double at = x[i + std::size_t(lane)];
      EXPECT_EQ(together[lane], batched(B(at))[lane]) << at;
      EXPECT_NEAR(together[lane], one(at), tolerance * std::abs(one(at))) << at;
    }
  }
}

constexpr double epsilon = std::numeric_limits<double>::epsilon();

TEST(BatchFunctions, SineAndCosineAreThoseOfTheLibraryToARoundOff) {
  expect_lanes([](const B& x) { return sin(x); }, [](double x) { return std::sin(x); }, arguments(), epsilon);
  expect_lanes([](const B& x) { return cos(x); }, [](double x) { return std::cos(x); }, arguments(), epsilon);
  EXPECT_TRUE(std::isnan(sin(B(std::numeric_limits<double>::infinity()))[0]));
}

TEST(BatchFunctions, SpecialFunctionsAreTheScalarOnes) {
  std::vector<double> squares;
  std::vector<double> cosines;
  for (const double x : arguments()) squares.push_back(std::min(x * x, 1e6));
  for (const double x : arguments()) cosines.push_back(std::cos(x));
  for (double& w : cosines) w = std::max(w, -0.99);
  expect_lanes([](const B& x) { return stumpff<1>(x); }, [](double x) { return stumpff<1>(x); }, squares, 4 * epsilon);
  expect_lanes([](const B& x) { return stumpff<2>(x); }, [](double x) { return stumpff<2>(x); }, squares, 4 * epsilon);
  expect_lanes([](const B& w) { return angle_ratio<0>(w); }, [](double w) { return angle_ratio<0>(w); }, cosines,
               8 * epsilon);
  expect_lanes([](const B& w) { return angle_ratio<1>(w); }, [](double w) { return angle_ratio<1>(w); }, cosines,
               8 * epsilon);
}

TEST(BatchFunctions, RotationsOfEveryAngleHaveTheLogarithmsOfOne) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 200; ++k) {
    Matrix<B, 3, 3> g;
    std::vector<Matrix<double, 3, 3>> one;
    for (int lane = 0; lane < B::lanes; ++lane) {
      const Vector<double, 3> w = Vector<double, 3>(normal(random), normal(random), normal(random)).normalized() *
                                  (lane % 2 == 0 ? 3.14 * lane / B::lanes : 3.1);
      one.push_back(SO3::exp(w));
      for (int i = 0; i < 9; ++i) g(i).set(lane, one.back()(i));
    }
    const Vector<B, 3> log = SO3::log(g);
    for (int lane = 0; lane < B::lanes; ++lane)
      EXPECT_LT((detail::lane_of(log, lane) - SO3::log(one[std::size_t(lane)])).norm(), 1e-13);
  }
}

/// What a user would write with `select` in place of a branch.
template <class S> S kinked(const S& x) { return select(value_of(x) < 0.5, x * x, 0.25 + 1.0 * (x - 0.5)); }

TEST(BatchFunctions, SelectTakesTheBranchOfEachLaneWithItsDerivatives) {
  using J = Jet<B, 1>;
  B x = 0.25;
  x.set(1, 0.75);
  const J f = kinked(J::variable(x, 0));
  EXPECT_EQ(f.value[0], 0.0625);
  EXPECT_EQ(f.gradient(0)[0], 0.5);
  EXPECT_EQ(f.value[1], 0.5);
  EXPECT_EQ(f.gradient(0)[1], 1);
  EXPECT_EQ(kinked(0.75), 0.5);
  const J angle = atan2(J::variable(x, 0), J(-1.0));
  EXPECT_NEAR(angle.value[1], std::atan2(0.75, -1), 1e-15);
  EXPECT_NEAR(angle.gradient(0)[0], -1 / (1 + 0.0625), 1e-15);
}

// ---- laws of ensembles

State<SO3> draw_body() { return {{}, laws::draw_vector<3>(20)}; }
State<Pair<1>> draw_pendulum() { return {laws::draw_vector<1>(3), laws::draw_vector<1>(3)}; }
State<PlateBall::GroupoidType> draw_ball() {
  State<PlateBall::GroupoidType> s;
  std::get<0>(s.object) = laws::draw_vector<2>(3);
  s.momentum = laws::draw_vector<5>(3);
  return s;
}

TEST(EnsembleLaws, RigidBody) {
  RigidBody body;
  const auto exponential = laws::ensemble_laws(body, draw_body);
  EXPECT_TRUE(exponential.holds()) << exponential;
  body.rotation = RotationMap::cayley;
  const auto cayley = laws::ensemble_laws(body, draw_body);
  EXPECT_TRUE(cayley.holds()) << cayley;
}

TEST(EnsembleLaws, Pendulum) {
  Pendulum pendulum;
  pendulum.h = 0.05;
  const auto report = laws::ensemble_laws(pendulum, draw_pendulum);
  EXPECT_TRUE(report.holds()) << report;
}

TEST(EnsembleLaws, PlateBall) {
  PlateBall ball;
  ball.spin = 0.4;
  const auto report = laws::ensemble_laws(ball, draw_ball, 11, 20);
  EXPECT_TRUE(report.holds()) << report;
}

#if defined(__AVX2__)
TEST(EnsembleLaws, NarrowerBatches) {
  const auto report = laws::ensemble_laws<2>(Pendulum{}, draw_pendulum);
  EXPECT_TRUE(report.holds()) << report;
}
#endif

/// Every kind of broken ensemble, one member function at a time.
struct Perturbed : Ensemble<Pendulum> {
  using Ensemble<Pendulum>::Ensemble;
  TrajectoryPoint<Pendulum> point(long member) const {
    auto out = Ensemble<Pendulum>::point(member);
    out.state.momentum(0) += 1e-9 + 1e-9 * out.state.momentum(0);
    return out;
  }
};
struct KnowsItsPlace : Ensemble<Pendulum> {
  using Ensemble<Pendulum>::Ensemble;
  TrajectoryPoint<Pendulum> point(long member) const {
    auto out = Ensemble<Pendulum>::point(member);
    out.state.momentum(0) += 1e-15 * double(member);
    return out;
  }
};
struct FailsTogether : Ensemble<Pendulum> {
  using Ensemble<Pendulum>::Ensemble;
  SolveStatus status(long member) const {
    return failures() > 0 ? SolveStatus::singular : Ensemble<Pendulum>::status(member);
  }
};
struct CountsAdvances : Ensemble<Pendulum> {
  using Ensemble<Pendulum>::Ensemble;
  int advances = 0;
  bool advance_to(long index, const EnsembleOptions<Pendulum>& options = {}) {
    ++advances;
    return Ensemble<Pendulum>::advance_to(index, options);
  }
  TrajectoryPoint<Pendulum> point(long member) const {
    auto out = Ensemble<Pendulum>::point(member);
    out.index += advances;
    return out;
  }
};

template <class Members> laws::LawReport laws_of() {
  return laws::ensemble_laws_of<Members>(Pendulum{}, draw_pendulum, 19, 10, 1e-11);
}

TEST(BrokenEnsemble, AMemberOfAnotherTrajectory) {
  EXPECT_TRUE(laws::seen_broken(laws_of<Perturbed>().law("a member is its own trajectory")));
}
TEST(BrokenEnsemble, AMemberThatKnowsItsPlace) {
  EXPECT_TRUE(laws::seen_broken(laws_of<KnowsItsPlace>().law("members do not know their order")));
}
TEST(BrokenEnsemble, AFailureThatSpreads) {
  EXPECT_TRUE(laws::seen_broken(laws_of<FailsTogether>().law("a member fails alone")));
}
TEST(BrokenEnsemble, APauseThatIsSeen) {
  EXPECT_TRUE(laws::seen_broken(laws_of<CountsAdvances>().law("threads and pauses change nothing")));
}

// ---- what else it promises

std::vector<State<SO3>> bodies(int count) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::vector<State<SO3>> out;
  for (int i = 0; i < count; ++i) out.push_back({{}, {normal(random), normal(random), normal(random)}});
  return out;
}

TEST(Ensemble, MomentumAndEnergyAreKeptAsByOneIntegrator) {
  RigidBody body;
  const auto initial = bodies(B::lanes);
  constexpr long steps = 200000;
  Ensemble<RigidBody> ensemble(body, initial);
  ensemble.advance_to(steps);
  const auto drift_of = [](const TrajectoryPoint<RigidBody>& p, const State<SO3>& start) {
    return (p.configuration * p.state.momentum - start.momentum).norm() / start.momentum.norm();
  };
  double drift = 0;
  double drift_alone = 0;
  for (std::size_t i = 0; i < initial.size(); ++i) {
    const auto point = ensemble.point(long(i));
    ASSERT_EQ(point.index, steps);
    drift = std::max(drift, drift_of(point, initial[i]));
    EXPECT_NEAR(body.energy(point.state), body.energy(initial[i]), 1e-4 * body.energy(initial[i])) << i;
    FixedStepIntegrator<RigidBody> alone(body, initial[i], Matrix<double, 3, 3>::Identity(),
                                         std::make_unique<NewtonStep<RigidBody>>());
    for (long k = 0; k < steps; ++k) ASSERT_TRUE(alone.advance().converged());
    drift_alone = std::max(drift_alone, drift_of(alone.point(), initial[i]));
  }
  EXPECT_LT(drift, 3 * drift_alone);  // the worst of a few, of sums that round differently
  EXPECT_LT(drift, 1e-12);
}

/// Steps so long that many have no solution, some of them only after others.
struct LongSteps {
  static constexpr long steps = 12;
  PlateBall ball;
  std::vector<State<PlateBall::GroupoidType>> initial{32};
  LongSteps() {
    ball.spin = 0.4;
    ball.h = 0.5;
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    for (auto& s : initial) {
      std::get<0>(s.object) << normal(random), normal(random);
      for (double& m : s.momentum) m = 4 * normal(random);
    }
  }
};

TEST(Ensemble, LongStepsFailWhereTheyFailOneByOne) {
  const LongSteps run;
  Ensemble<PlateBall> ensemble(run.ball, run.initial);
  ensemble.advance_to(run.steps);
  for (std::size_t i = 0; i < run.initial.size(); ++i) {
    FixedStepIntegrator<PlateBall> alone(run.ball, run.initial[i], run.ball.groupoid.unit(run.initial[i].object),
                                         std::make_unique<NewtonStep<PlateBall>>());
    for (long k = 0; k < run.steps && alone.advance().converged(); ++k) continue;
    EXPECT_EQ(ensemble.point(long(i)).index, alone.point().index) << i;
  }
}

TEST(Ensemble, AMemberThatFailsSaysWhyAndKeepsItsLastState) {
  const LongSteps run;
  Ensemble<PlateBall> ensemble(run.ball, run.initial);
  EXPECT_TRUE(ensemble.advance_to(run.steps));
  EXPECT_LT(ensemble.failures(), ensemble.size());
  int on_the_way = 0;
  for (long i = 0; i < ensemble.size(); ++i) {
    const auto last = ensemble.point(i);
    EXPECT_EQ(ensemble.status(i) == SolveStatus::converged, last.index == run.steps) << i;
    if (last.index == run.steps || last.index == 0) continue;
    ++on_the_way;
    Ensemble<PlateBall> until_there(run.ball, run.initial);
    until_there.advance_to(last.index);
    EXPECT_EQ(until_there.status(i), SolveStatus::converged) << i;
    EXPECT_EQ(until_there.state(i).momentum, last.state.momentum) << i;
  }
  EXPECT_GT(on_the_way, 2);
}

TEST(Ensemble, ObservationsComeInOrderAndAnInterruptCanBeTakenUp) {
  const RigidBody body;
  const auto initial = bodies(100);
  std::vector<std::vector<long>> seen(initial.size());
  EnsembleOptions<RigidBody> options;
  options.threads = 2;
  options.every = 50;
  options.observe = [&](long member, const TrajectoryPoint<RigidBody>& point) {
    seen[std::size_t(member)].push_back(point.index);
    EXPECT_DOUBLE_EQ(point.time, double(point.index) * body.h);
  };
  int asked = 0;
  options.interrupted = [&] { return ++asked > 3; };
  Ensemble<RigidBody> ensemble(body, initial);
  EXPECT_FALSE(ensemble.advance_to(300, options));
  options.interrupted = nullptr;
  EXPECT_TRUE(ensemble.advance_to(300, options));
  for (const auto& indices : seen) EXPECT_EQ(indices, (std::vector<long>{50, 100, 150, 200, 250, 300}));
}

TEST(Ensemble, StepsAllocateNothing) {
  if (allocation_count() < 0) GTEST_SKIP() << "allocations can not be counted here";
  Ensemble<RigidBody> ensemble(RigidBody{}, bodies(32));
  ensemble.advance_to(10);
  const auto during = [&](long index) {
    const long before = allocation_count();
    ensemble.advance_to(index);
    return allocation_count() - before;
  };
  const long one = during(11);
  EXPECT_EQ(during(200), one);  // what an advance takes, however many steps it makes
}

TEST(Ensemble, ToBeObservedAtNoStepIsRefused) {
  const auto initial = bodies(3);
  Ensemble<RigidBody> ensemble(RigidBody{}, initial);
  EnsembleOptions<RigidBody> options;
  options.every = 0;
  EXPECT_THROW(ensemble.advance_to(1, options), std::invalid_argument);
}

TEST(Ensemble, AWrongNumberOfConfigurationsIsRefused) {
  const auto initial = bodies(3);
  const std::vector<Matrix<double, 3, 3>> configurations(2, Matrix<double, 3, 3>::Identity());
  EXPECT_THROW(Ensemble<RigidBody>(RigidBody{}, initial, configurations), std::invalid_argument);
}

}  // namespace
}  // namespace solvers_ensemble_tests
