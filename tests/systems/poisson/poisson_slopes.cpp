// Derivatives of steps on Poisson manifolds by their points and by parameters, and of runs; those of extrapolated steps
// hold the inner steps that the tolerance asked for.
#include <lagroid/solvers/poisson/poisson_integrators.hpp>
#include <lagroid/solvers/sensitivity/linearised_poisson_motion.hpp>
#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>
#include <lagroid/systems/poisson/fields.hpp>
#include <lagroid/systems/poisson/lotka_volterra.hpp>
#include <lagroid/systems/poisson/rotations.hpp>
#include <lagroid/systems/poisson/tops.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace lagroid {

// Those are in the library; here are only the test's own.
LAGROID_POISSON_INTEGRATORS(extern template, EulerTop);
LAGROID_POISSON_INTEGRATORS(extern template, HeavyTopBracket);
LAGROID_POISSON_INTEGRATORS(extern template, Kirchhoff);
LAGROID_POISSON_INTEGRATORS(extern template, LotkaVolterra);
LAGROID_POISSON_INTEGRATORS(extern template, Sklyanin);
LAGROID_POISSON_INTEGRATORS(extern template, ThreeSpecies);

namespace poisson_slopes_tests {
namespace {

template <class Sys> std::vector<std::string> all_names() {
  const Sys system;
  return all_parameters(system).names;
}

/// Where a run of a few steps ends, from a start and parameters that differ: number `j` by `by`, those of the start
/// first.
template <class Sys>
Eigen::VectorXd end_of(const Vector<double, Sys::dimension>& start, const PoissonOptions& options, int j, double by) {
  Sys system;
  Vector<double, Sys::dimension> x = start;
  if (j < Sys::dimension) {
    x(j) += by;
  } else {
    const_cast<double&>(*all_parameters(system).members[std::size_t(j - Sys::dimension)]) += by;
  }
  const auto motion = make_poisson_integrator(system, x, options);
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(motion->advance().converged());
  const auto y = motion->point();
  return Eigen::Map<const Eigen::VectorXd>(y.data(), Sys::dimension);
}

/// How far a derivative is from differences of `end`, two widths extrapolated, over their size.
template <class End> double missed_by(const Eigen::VectorXd& derivative, const End& end) {
  const auto difference = [&](double by) -> Eigen::VectorXd { return (end(by) - end(-by)) / (2 * by); };
  const Eigen::VectorXd found =
      (16 * (4 * difference(1e-3) - difference(2e-3)) - (4 * difference(2e-3) - difference(4e-3))) / 45;
  return (derivative - found).norm() / std::max(1.0, found.norm());
}

template <class Sys> Propagated propagated(const Vector<double, Sys::dimension>& start, const PoissonOptions& options) {
  const auto names = all_names<Sys>();
  LinearisedPoissonMotion motion(make_poisson_integrator(Sys(), start, options), names);
  const int count = motion.states() + motion.parameters();
  return propagate_forward(motion, 5, Eigen::MatrixXd::Identity(count, count));
}

/// How far derivatives of a run are from extrapolated differences of runs, over these, column by column.
template <class Sys>
Eigen::ArrayXd missed_differences(const Vector<double, Sys::dimension>& start, const PoissonOptions& options) {
  const Propagated run = propagated<Sys>(start, options);
  EXPECT_TRUE(run.converged()) << run.message;
  EXPECT_EQ(run.derivatives.cols(), Sys::dimension + Eigen::Index(all_names<Sys>().size()));
  Eigen::ArrayXd missed(run.derivatives.cols());
  for (int j = 0; j < run.derivatives.cols(); ++j) {
    const auto end = [&](double by) { return end_of<Sys>(start, options, j, by); };
    missed(j) = missed_by(run.derivatives.col(j), end);
  }
  return missed;
}

template <class Sys>
void expect_differences(const Vector<double, Sys::dimension>& start, const PoissonOptions& options) {
  SCOPED_TRACE(options.method);
  const Eigen::ArrayXd missed = missed_differences<Sys>(start, options);
  EXPECT_TRUE((missed < 2e-9).all()) << missed.transpose();
}

TEST(PoissonSlopes, AreWhatDifferencesOfRunsTendTo) {
  for (const std::string_view method : poisson_methods_of<ThreeSpecies>())
    if (method != "extrapolation")
      expect_differences<ThreeSpecies>({1, 1.9, 0.5}, {.method = std::string(method), .step = 0.05});
  expect_differences<EulerTop>({0.8, 0.6, 1.1}, {.method = "symplectic-groupoid", .step = 0.1});
  expect_differences<EulerTop>({0.8, 0.6, 1.1}, {.method = "hamilton-jacobi-6", .step = 0.1});
  expect_differences<Kirchhoff>({0.4, 0.2, -0.6, 0.7, -0.1, 0.5}, {.method = "symplectic-groupoid", .step = 0.1});
  expect_differences<Sklyanin>({0.7, 0.4, -0.5, 0.6}, {.method = "symplectic-groupoid", .step = 0.1});
  expect_differences<LotkaVolterra>({2, 0.5},
                                    {.method = "splitting", .step = 0.1, .composition = compositions::suzuki});
}

/// Of a step that ends off the Casimirs and goes back to them.
TEST(PoissonSlopes, GoTheWayBackToTheCasimirs) {
  const PoissonOptions options{.method = "projected-midpoint", .step = 0.2};
  expect_differences<ThreeSpecies>({1, 1.9, 0.5}, options);
  Vector<double, 6> top;
  top << 0.3, 0.4, 1.2, 0, 0.6, 0.8;
  expect_differences<HeavyTopBracket>(top, options);
  expect_differences<Sklyanin>({0.7, 0.4, -0.5, 0.6}, options);
  // That of the step before it is another.
  const Vector<double, 3> start(1, 1.9, 0.5);
  PoissonOptions before = options;
  before.method = "midpoint";
  const Eigen::MatrixXd back = propagated<ThreeSpecies>(start, options).derivatives;
  EXPECT_GT((propagated<ThreeSpecies>(start, before).derivatives - back).norm(), 1e-4 * back.norm());
  const auto casimirs = [](const Vector<double, 3>& x) -> Eigen::MatrixXd {
    return Levels<ThreeSpecies, false>::slope_of_values(ThreeSpecies(), x);
  };
  const Vector<double, 3> end = end_of<ThreeSpecies>(start, options, 0, 0);
  EXPECT_LT((casimirs(end) * back.leftCols(3) - casimirs(start)).norm(), 1e-13 * back.norm());
}

TEST(PoissonSlopes, FollowAPathOfNoise) {
  PoissonOptions options{.step = 0.05};
  options.noise = {.strength = {0.2, 0.3, 0.1}, .seed = 5};
  expect_differences<EulerTop>({0.8, 0.6, 1.1}, options);
  options.noise.temperature = 0.5;
  expect_differences<EulerTop>({0.8, 0.6, 1.1}, options);
}

TEST(PoissonSlopes, OfRunsKeepTheBracketAndCasimirs) {
  const Vector<double, 3> start(1, 1.9, 0.5);
  const ThreeSpecies system;
  LinearisedPoissonMotion motion(make_poisson_integrator(system, start, {.step = 0.1}), {"lambda", "mu"});
  const Propagated run = propagate_forward(motion, 200, Eigen::MatrixXd::Identity(5, 5));
  ASSERT_TRUE(run.converged());
  const Eigen::MatrixXd by_start = run.derivatives.leftCols(3);
  const Vector<double, 3> end = run.values;
  EXPECT_LT((by_start * system.bivector(start) * by_start.transpose() - system.bivector(end)).norm(),
            1e-12 * run.growth * run.growth);
  // A Casimir at the end changes as it does at the start, and by no parameter that it does not depend on.
  const auto slope = [&](const Vector<double, 3>& x) {
    return gradient_of([&](const auto& y) { return system.casimirs(y)(0); }, x).transpose().eval();
  };
  EXPECT_LT((slope(end) * by_start - slope(start)).norm(), 1e-12 * run.growth);
  EXPECT_LT((slope(end) * run.derivatives.rightCols(2)).norm(), 1e-12 * run.growth);
}

TEST(PoissonSlopes, BackwardsAreThoseForward) {
  const Vector<double, 6> start(0.4, 0.2, -0.6, 0.7, -0.1, 0.5);
  const auto motion = [&] {
    return LinearisedPoissonMotion(make_poisson_integrator(Kirchhoff(), start, {.step = 0.1}), {"A", "kappa"});
  };
  auto one = motion(), other = motion();
  ASSERT_EQ(one.parameters(), 4);
  const Propagated forward = propagate_forward(one, 300, Eigen::MatrixXd::Identity(10, 10));
  const Propagated backward = propagate_backward(other, 300);
  ASSERT_TRUE(forward.converged() && backward.converged());
  EXPECT_LT((forward.derivatives - backward.derivatives).norm(), 1e-12 * forward.derivatives.norm());
}

/// Reads its parameter as a plain number.
struct Deaf : PoissonSystem<Deaf, 2> {
  double rate = 1.5;
  static auto parameters() { return std::tuple(parameter("rate", &Deaf::rate, "1/s", "of both")); }
  template <class S> Matrix<S, 2, 2> bivector(const Vector<S, 2>&) const { return skew<S, 2>({{0, 1, S(1.0)}}); }
  template <class S> S hamiltonian(const Vector<S, 2>& x) const { return (x(0) * x(0) + x(1) * x(1)) * (0.5 * rate); }
};

TEST(PoissonSlopes, WhatHasNoDerivativeIsRefusedByName) {
  const auto deaf = make_poisson_integrator(Deaf(), {1, 0.2}, {.step = 0.1});
  EXPECT_EQ(deaf->slope({}).cols(), 2);
  try {
    deaf->slope({"rate"});
    FAIL() << "a derivative of zero was believed";
  } catch (const WithoutDerivative& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("parameter rate carries no derivative"), std::string::npos);
  }
  EXPECT_THROW(make_poisson_integrator(LotkaVolterra(), {2, 0.5}, {})->slope({"mass"}), std::invalid_argument);
  const auto by_a_tolerance = make_poisson_integrator(Deaf(), {1, 0.2}, {.method = "extrapolation", .step = 0.1});
  EXPECT_EQ(by_a_tolerance->slope({}).cols(), 2);
  EXPECT_THROW(by_a_tolerance->slope({"rate"}), WithoutDerivative);
}

PoissonOptions extrapolation(double step, double tolerance) {
  return {.method = "extrapolation", .step = step, .tolerance = tolerance};
}
constexpr double coarse = 1e-3;  ///< by which inner steps leave errors that the levels take back
constexpr int nodes = 5;         ///< of the runs above

/// A run by the inner steps of another, node after node, whatever it begins from.
template <class Sys> struct ByHeldPoissonSteps {
  using X = Vector<double, Sys::dimension>;
  std::vector<std::vector<typename HeldPoissonSteps<Sys>::Inner>> inner;
  std::vector<X> points;  ///< of the run that they are of

  ByHeldPoissonSteps(const X& start, const PoissonOptions& options) {
    detail::ExtrapolatedPoissonSteps<Sys> run(Sys(), start, options);
    std::size_t made = 0;
    for (int k = 0; k < nodes; ++k) {
      const auto at = run.point();
      points.push_back(Eigen::Map<const X>(at.data()));
      inner.push_back(run.next_inner_steps());
      made += inner.back().size();
      EXPECT_TRUE(run.advance().converged());
    }
    EXPECT_GT(made, inner.size()) << "of one size each";
  }
  /// Of another system, where its numbers are those of Sys.
  template <class Other = Sys> auto at_node(const Other& system, const X& x, int k) const {
    std::vector<typename HeldPoissonSteps<Other>::Inner> steps;
    for (const auto& each : inner[std::size_t(k)]) steps.push_back({each.size, each.rows});
    return HeldPoissonSteps<Other>(system, x, steps);
  }
  /// The end of a run that differs in number j by so much, those of the start first.
  Eigen::VectorXd end_of(X x, int j, double by) const {
    Sys system;
    if (j < Sys::dimension) {
      x(j) += by;
    } else {
      const_cast<double&>(*all_parameters(system).members[std::size_t(j - Sys::dimension)]) += by;
    }
    for (int k = 0; k < nodes; ++k) x = at_node(system, x, k).end();
    return x;
  }
  /// How far derivatives are from extrapolated differences.
  double missed(const Eigen::MatrixXd& derivatives) const {
    double most = 0;
    for (int j = 0; j < derivatives.cols(); ++j)
      detail::raise(most, missed_by(derivatives.col(j), [&](double by) { return end_of(points.front(), j, by); }));
    return most;
  }
};

template <class Sys>
void expect_differences_by_held_steps(const Vector<double, Sys::dimension>& start, double step, double bound) {
  for (const double tolerance : {coarse, 1e-6, 1e-12}) {
    SCOPED_TRACE(tolerance);
    const PoissonOptions options = extrapolation(step, tolerance);
    const Propagated run = propagated<Sys>(start, options);
    ASSERT_TRUE(run.converged()) << run.message;
    EXPECT_LT(ByHeldPoissonSteps<Sys>(start, options).missed(run.derivatives), bound);
  }
}
const Vector<double, 6> top = (Vector<double, 6>() << 0.3, 0.4, 1.2, 0, 0.6, 0.8).finished();

TEST(ExtrapolatedPoissonSlopes, AreWhatDifferencesByTheSameInnerStepsTendTo) {
  expect_differences_by_held_steps<LotkaVolterra>({2, 0.5}, 1.5, 1e-8);
  expect_differences_by_held_steps<ThreeSpecies>({1, 1.9, 0.5}, 1, 1e-8);
  expect_differences_by_held_steps<HeavyTopBracket>(top, 1, 1e-8);
}

/// The field of Sys, without levels that its steps could be taken back to.
template <class Sys> struct Adrift : PoissonSystem<Adrift<Sys>, Sys::dimension> {
  template <class S> Matrix<S, Sys::dimension, Sys::dimension> bivector(const Vector<S, Sys::dimension>& x) const {
    return Sys().bivector(x);
  }
  template <class S> S hamiltonian(const Vector<S, Sys::dimension>&) const { return S(1.0); }
  template <class S> Vector<S, Sys::dimension> velocity(const Vector<S, Sys::dimension>& x) const {
    return Sys().velocity(x);
  }
};
template <class Sys>
double missed_without_projection(const Vector<double, Sys::dimension>& start, const PoissonOptions& options) {
  const ByHeldPoissonSteps<Sys> held(start, options);
  Eigen::MatrixXd product = Eigen::MatrixXd::Identity(Sys::dimension, Sys::dimension);
  for (int k = 0; k < nodes; ++k)
    product = (held.at_node(Adrift<Sys>(), held.points[std::size_t(k)], k).slope() * product).eval();
  return held.missed(product);
}

TEST(ExtrapolatedPoissonSlopes, WithoutTheProjectionMissTheDifferences) {
  EXPECT_GT(missed_without_projection<LotkaVolterra>({2, 0.5}, extrapolation(1.5, coarse)), 1e-5);
  EXPECT_GT(missed_without_projection<HeavyTopBracket>(top, extrapolation(1, coarse)), 1e-5);
}

TEST(ExtrapolatedPoissonSlopes, MissDifferencesOfRunsByTheirOwnInnerStepsByTheTolerance) {
  EXPECT_GT(missed_differences<LotkaVolterra>({2, 0.5}, extrapolation(1.5, coarse)).maxCoeff(), 1e-7);
  expect_differences<LotkaVolterra>({2, 0.5}, extrapolation(1.5, 1e-13));
  expect_differences<ThreeSpecies>({1, 1.9, 0.5}, extrapolation(0.5, 1e-13));
  expect_differences<HeavyTopBracket>(top, extrapolation(0.5, 1e-13));
  expect_differences<EulerTop>({0.8, 0.6, 1.1}, extrapolation(0.5, 1e-13));
  expect_differences<Kirchhoff>({0.4, 0.2, -0.6, 0.7, -0.1, 0.5}, extrapolation(0.5, 1e-13));
  expect_differences<Sklyanin>({0.7, 0.4, -0.5, 0.6}, extrapolation(0.5, 1e-13));
}

TEST(ExtrapolatedPoissonSlopes, LeaveEnergyAndCasimirsWhatTheyAreAtTheStart) {
  const Vector<double, 3> start(1, 1.9, 0.5);
  const Propagated run = propagated<ThreeSpecies>(start, extrapolation(1, coarse));
  ASSERT_TRUE(run.converged());
  const ThreeSpecies system;
  const auto members = all_parameters(system).members;
  using OnLevels = Levels<ThreeSpecies, true>;
  const Eigen::MatrixXd at_start = OnLevels::slope_of_values(system, start, members);
  const Eigen::MatrixXd at_end =
      detail::chained(OnLevels::slope_of_values(system, run.values, members), run.derivatives);
  EXPECT_LT((at_end - at_start).norm(), 1e-12 * run.growth);
}

TEST(ExtrapolatedPoissonSlopes, BackwardsAreThoseForward) {
  const auto motion = [&] {
    return LinearisedPoissonMotion(make_poisson_integrator(HeavyTopBracket(), top, extrapolation(0.5, 1e-9)),
                                   {"inertia", "weight"});
  };
  auto one = motion(), other = motion();
  ASSERT_EQ(one.parameters(), 6);
  const Propagated forward = propagate_forward(one, 60, Eigen::MatrixXd::Identity(12, 12));
  const Propagated backward = propagate_backward(other, 60);
  ASSERT_TRUE(forward.converged() && backward.converged());
  EXPECT_LT((forward.derivatives - backward.derivatives).norm(), 1e-12 * forward.derivatives.norm());
}

/// A run at rest has no error, whatever its inner steps, and these are as long as nodes are apart; its derivative,
/// which turns, has one.
TEST(ExtrapolatedPoissonSlopes, AtAnEquilibriumAreAsCoarseAsTheNodes) {
  const auto missed = [](double step) {
    LinearisedPoissonMotion motion(make_poisson_integrator(LotkaVolterra(), {1, 1}, extrapolation(step, 1e-12)), {});
    const Propagated run = propagate_forward(motion, std::lround(6 / step), Eigen::MatrixXd::Identity(2, 2));
    return (run.derivatives - Matrix<double, 2, 2>{{std::cos(6), -std::sin(6)}, {std::sin(6), std::cos(6)}}).norm();
  };
  EXPECT_GT(missed(1.5), 0.1);
  EXPECT_LT(missed(0.1), 1e-4);
}

TEST(ExtrapolatedPoissonSlopes, LeaveTheRunAsItIs) {
  const PoissonOptions options = extrapolation(0.7, 1e-10);
  const auto seen = make_poisson_integrator(LotkaVolterra(), {2, 0.5}, options);
  const auto alone = make_poisson_integrator(LotkaVolterra(), {2, 0.5}, options);
  for (int k = 0; k < 5; ++k) {
    EXPECT_TRUE(seen->slope({"growth"}).allFinite());
    ASSERT_TRUE(seen->advance().converged() && alone->advance().converged());
    ASSERT_EQ(seen->point(), alone->point());
  }
}

}  // namespace
}  // namespace poisson_slopes_tests
}  // namespace lagroid
