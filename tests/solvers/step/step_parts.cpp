// The parts of a step: small inverses, first guesses, and that the short way through a step is the long one.
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/linear_algebra/small_inverse.hpp>
#include <lagroid/solvers/step/extrapolation.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

using namespace lagroid;

namespace step_step_parts_tests {
namespace {

/// Random, with a leading block of zeros (as multipliers make them) and rows of very different sizes.
template <int N> Matrix<double, N, N> saddle(std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  Matrix<double, N, N> a;
  for (int i = 0; i < a.size(); ++i) a(i) = normal(generator);
  a.template topLeftCorner<N / 2, N / 2>().setZero();
  for (int i = 0; i < N; ++i) a.row(i) *= std::exp2(3 * i);
  return a;
}

template <int N> void expect_inverse() {
  std::mt19937_64 generator(N);
  std::normal_distribution<double> normal(0, 1e-3);
  int tried = 0;
  for (int trial = 0; trial < 100; ++trial) {
    Matrix<double, N, N> a = saddle<N>(generator);
    const auto scaling = Scaling<N>::equilibrate(a);
    if (Eigen::MatrixXd(scaling.apply(a)).partialPivLu().rcond() < 1e-3) continue;
    ++tried;
    SmallInverse<N> inverse;
    inverse.choose_pivots(a, scaling);
    // The pivots chosen for `a` serve its neighbours too.
    a.array() *= 1 + normal(generator);
    typename SmallInverse<N>::Column b;
    for (int i = 0; i < N; ++i) b(i) = a(i, i % N) + 1;
    ASSERT_TRUE(inverse.invert(a));
    const Eigen::VectorXd expected = -Eigen::MatrixXd(a).fullPivLu().solve(Eigen::VectorXd(b));
    EXPECT_LT((Eigen::VectorXd(inverse.correction(b)) - expected).norm(), 1e-9 * (1 + expected.norm())) << N;
  }
  EXPECT_GT(tried, 50) << N;
}

TEST(SmallInverse, OfEveryKind) {
  expect_inverse<1>();
  expect_inverse<3>();
  expect_inverse<4>();
  expect_inverse<5>();
  expect_inverse<8>();
  expect_inverse<10>();
}

template <int N> void expect_refusal() {
  Matrix<double, N, N> a = Matrix<double, N, N>::Ones();  // rank one
  SmallInverse<N> inverse;
  inverse.choose_pivots(a, Scaling<N>::equilibrate(a));
  EXPECT_FALSE(inverse.invert(a)) << N;
  for (const int entry : {0, N * N / 2, N * N - 1}) {
    a.setIdentity();
    a(entry) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(inverse.invert(a)) << N << ' ' << entry;
  }
}
TEST(SmallInverse, RefusesWhatHasNone) {
  expect_refusal<3>();
  expect_refusal<8>();
  expect_refusal<10>();
}

TEST(Extrapolation, ContinuesPolynomials) {
  Extrapolation<1, 5> past;
  const auto p = [](double t) { return Vector<double, 1>(1 + t * (0.3 - t * (0.02 + t * (0.001 - 1e-4 * t)))); };
  for (int k = 0; k < 40; ++k) {
    if (k > 10) {
      EXPECT_NEAR(past.next()(0), p(0.1 * k)(0), 1e-12) << k;
    }
    past.push(p(0.1 * k));
  }
}

TEST(Extrapolation, DoesNotAmplifyNoise) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> noise(-1, 1);
  Extrapolation<1, 7> past;
  for (int k = 0; k < 200; ++k) past.push(Vector<double, 1>(noise(generator)));
  EXPECT_LE(std::abs(past.next()(0)), 3) << "degree 7 would reach 255";
}

TEST(Extrapolation, StartsWithWhatItHas) {
  Extrapolation<1, 7> past;
  past.push(Vector<double, 1>(2));
  EXPECT_EQ(past.next()(0), 2);
  past.push(Vector<double, 1>(3));
  past.clear();
  past.push(Vector<double, 1>(5));
  EXPECT_EQ(past.next()(0), 5);
}

/// A solver that remembers nothing from step to step: every step goes the long way.
template <DiscreteSystem Sys> class Forgetful final : public StepSolver<Sys> {
 public:
  StepReport solve(const Sys& system, const State<typename Sys::GroupoidType>& state,
                   StepSolution<Sys>& solution) override {
    return NewtonStep<Sys>().solve(system, state, solution);
  }
};

template <class Sys>
void expect_one_trajectory(const Sys& system, const State<typename Sys::GroupoidType>& state, int steps) {
  const auto unit = system.groupoid.unit(state.object);
  FixedStepIntegrator<Sys> quick(system, state, unit, std::make_unique<NewtonStep<Sys>>());
  FixedStepIntegrator<Sys> slow(system, state, unit, std::make_unique<Forgetful<Sys>>());
  for (int k = 0; k < steps; ++k) {
    ASSERT_TRUE(quick.advance().converged()) << k;
    ASSERT_TRUE(slow.advance().converged()) << k;
    ASSERT_LT((quick.point().state.momentum - slow.point().state.momentum).norm(),
              1e-11 * slow.point().state.momentum.norm())
        << k;
  }
}

TEST(NewtonStep, TheShortWayIsTheLongOne) {
  State<PlateBall::GroupoidType> rolling;
  std::get<0>(rolling.object) << 0.3, -0.2;
  rolling.momentum << 0.9, 0.2, 0.6, -0.4, 0.8;
  PlateBall ball;
  ball.spin = 0.4;
  for (const auto form : {RotationForm::trace, RotationForm::exponential}) {
    ball.rotation = form;
    expect_one_trajectory(ball, rolling, 300);
  }
  // Eccentric: the matrix changes by orders of magnitude along the orbit, and guesses are bad near the centre.
  Kepler orbit;
  orbit.h = 0.02;
  expect_one_trajectory(orbit, State<Pair<2>>{{1.9, 0}, {0, 0.23}}, 600);
}

TEST(NewtonStep, ATightOrbitStaysAtRoundOff) {
  // Terms of the equations shrink by orders of magnitude between the centre and the far end: so must what is accepted.
  Kepler orbit;
  orbit.h = 1e-3;
  const auto rotation = orbit.symmetries()[0];
  const State<Pair<2>> start{{0.02, 0}, {0, 9.9}};
  FixedStepIntegrator<Kepler> integrator(orbit, start, {start.object, start.object},
                                         std::make_unique<NewtonStep<Kepler>>());
  double largest = 0;
  for (int k = 0; k < 3000; ++k) {
    const auto report = integrator.advance();
    ASSERT_TRUE(report.converged()) << k;
    largest = std::max(largest, report.roundoff_ratio);
    const auto at = rotation.momentum(integrator.point().state);
    ASSERT_NEAR(at, rotation.momentum(start), 1e-13) << k;
  }
  EXPECT_LE(largest, 1);
}

TEST(NewtonStep, OptionsHoldOnBothWays) {
  Kepler orbit;
  orbit.quadrature = Quadrature::midpoint;  // an implicit step
  const State<Pair<2>> start{{0.8, 0}, {0, 1.2}};
  const auto run = [&](NewtonOptions options, int steps) {
    FixedStepIntegrator<Kepler> integrator(orbit, start, {start.object, start.object},
                                           std::make_unique<NewtonStep<Kepler>>(options));
    std::vector<StepReport> reports;
    for (int k = 0; k < steps; ++k) {
      reports.push_back(integrator.advance());
      if (!reports.back().converged()) break;
    }
    return reports;
  };
  NewtonOptions loose;
  loose.tolerance = 1e-6;
  const auto tolerated = run(loose, 50);
  const auto exact = run({}, 50);
  ASSERT_EQ(tolerated.size(), 50U);
  int fewer = 0;
  bool stopped_early = false;
  for (int k = 0; k < 50; ++k) {
    EXPECT_LE(tolerated[k].residual, 1e-6);
    fewer += exact[k].iterations - tolerated[k].iterations;
    stopped_early = stopped_early || tolerated[k].roundoff_ratio > 1;
  }
  EXPECT_GT(fewer, 0);
  EXPECT_TRUE(stopped_early);
  NewtonOptions none;
  none.max_iterations = 0;
  EXPECT_EQ(run(none, 5).back().status, SolveStatus::not_converged);
}

/// Kepler with its two-sided derivative by hand (borrowed) and no gradients of its own.
struct OnlyTwoSided : Kepler {
  TwoSidedOf<Kepler> two_sided(const PairArrow<double, 2>& g, const Multipliers& lambda) const {
    return automatic_two_sided(static_cast<const Kepler&>(*this), g, lambda);
  }
};

TEST(NewtonStep, ATwoSidedDerivativeOfTheUserSuffices) {
  const State<Pair<2>> start{{0.8, 0}, {0, 1.2}};
  FixedStepIntegrator<OnlyTwoSided> with({}, start, {start.object, start.object},
                                         std::make_unique<NewtonStep<OnlyTwoSided>>());
  FixedStepIntegrator<Kepler> without({}, start, {start.object, start.object}, std::make_unique<NewtonStep<Kepler>>());
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(with.advance().converged());
    ASSERT_TRUE(without.advance().converged());
  }
  EXPECT_LT((with.point().state.momentum - without.point().state.momentum).norm(), 1e-13);
}

/// Fails when told to.
class Moody final : public StepSolver<Kepler> {
 public:
  explicit Moody(const bool& sulks) : sulks_(&sulks) {}
  StepReport solve(const Kepler& system, const State<Pair<2>>& state, StepSolution<Kepler>& solution) override {
    if (!*sulks_) return newton_.solve(system, state, solution);
    solution.step.arrow.target.setConstant(std::numeric_limits<double>::quiet_NaN());
    return {SolveStatus::stagnated, 1, 1.0, 1.0};
  }

 private:
  const bool* sulks_;
  NewtonStep<Kepler> newton_;
};

TEST(FixedStepIntegrator, GoesOnFromWhereItStoodAfterAFailure) {
  const State<Pair<2>> start{{0.8, 0}, {0, 1.2}};
  bool sulks = false;
  FixedStepIntegrator<Kepler> tried({}, start, {start.object, start.object}, std::make_unique<Moody>(sulks));
  FixedStepIntegrator<Kepler> steady({}, start, {start.object, start.object}, std::make_unique<NewtonStep<Kepler>>());
  for (int k = 0; k < 60; ++k) {
    sulks = k % 20 == 10;
    if (sulks) {
      const auto before = tried.point();
      EXPECT_EQ(tried.advance().status, SolveStatus::stagnated);
      EXPECT_EQ(tried.point().index, before.index);
      EXPECT_EQ(tried.point().state.object, before.state.object);
      EXPECT_EQ(tried.point().state.momentum, before.state.momentum);
      sulks = false;
    }
    ASSERT_TRUE(tried.advance().converged()) << k;
    ASSERT_TRUE(steady.advance().converged()) << k;
  }
  EXPECT_LT((tried.point().state.object - steady.point().state.object).norm(), 1e-13);
}

TEST(NewtonStep, AKeptMatrixDoesNotSpoilAnUnrelatedStep) {
  PlateBall ball;
  NewtonStep<PlateBall> kept;
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  int solved = 0;
  for (int k = 0; k < 100; ++k) {
    State<PlateBall::GroupoidType> state;
    std::get<0>(state.object) << normal(generator), normal(generator);
    for (int i = 0; i < 5; ++i) state.momentum(i) = normal(generator);
    StepSolution<PlateBall> a;
    StepSolution<PlateBall> b;
    a.step = b.step = ball.first_guess(state);
    const auto with = kept.solve(ball, state, a);
    const auto without = NewtonStep<PlateBall>().solve(ball, state, b);
    ASSERT_EQ(with.converged(), without.converged()) << k;
    if (with.converged()) {
      ++solved;
      EXPECT_LT((a.step.multipliers - b.step.multipliers).norm(), 1e-10);
    }
  }
  EXPECT_GT(solved, 50);
}

}  // namespace
}  // namespace step_step_parts_tests
