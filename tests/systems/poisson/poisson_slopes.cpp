// Derivatives of steps on Poisson manifolds by their points and by parameters, and of runs.
#include <lagroid/solvers/poisson/poisson_integrators.hpp>
#include <lagroid/solvers/sensitivity/linearised_poisson_motion.hpp>
#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>
#include <lagroid/systems/poisson/fields.hpp>
#include <lagroid/systems/poisson/lotka_volterra.hpp>
#include <lagroid/systems/poisson/rotations.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace lagroid {

// Those are in the library; here are only the test's own.
LAGROID_POISSON_INTEGRATORS(extern template, EulerTop);
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

template <class Sys> Propagated propagated(const Vector<double, Sys::dimension>& start, const PoissonOptions& options) {
  const auto names = all_names<Sys>();
  LinearisedPoissonMotion motion(make_poisson_integrator(Sys(), start, options), names);
  const int count = motion.states() + motion.parameters();
  return propagate_forward(motion, 5, Eigen::MatrixXd::Identity(count, count));
}

template <class Sys>
void expect_differences(const Vector<double, Sys::dimension>& start, const PoissonOptions& options) {
  SCOPED_TRACE(options.method);
  const Propagated run = propagated<Sys>(start, options);
  ASSERT_TRUE(run.converged()) << run.message;
  ASSERT_EQ(run.derivatives.cols(), Sys::dimension + Eigen::Index(all_names<Sys>().size()));
  for (int j = 0; j < run.derivatives.cols(); ++j) {
    const auto difference = [&](double by) -> Eigen::VectorXd {
      return (end_of<Sys>(start, options, j, by) - end_of<Sys>(start, options, j, -by)) / (2 * by);
    };
    // Two widths, extrapolated.
    const Eigen::VectorXd found =
        (16 * (4 * difference(1e-3) - difference(2e-3)) - (4 * difference(2e-3) - difference(4e-3))) / 45;
    EXPECT_LT((run.derivatives.col(j) - found).norm(), 2e-9 * std::max(1.0, found.norm())) << "column " << j;
  }
}

TEST(PoissonSlopes, AreWhatDifferencesOfRunsTendTo) {
  for (const std::string_view method : poisson_methods_of<ThreeSpecies>())
    if (method != "projected-midpoint" && method != "extrapolation")
      expect_differences<ThreeSpecies>({1, 1.9, 0.5}, {.method = std::string(method), .step = 0.05});
  expect_differences<EulerTop>({0.8, 0.6, 1.1}, {.method = "symplectic-groupoid", .step = 0.1});
  expect_differences<EulerTop>({0.8, 0.6, 1.1}, {.method = "hamilton-jacobi-6", .step = 0.1});
  expect_differences<Kirchhoff>({0.4, 0.2, -0.6, 0.7, -0.1, 0.5}, {.method = "symplectic-groupoid", .step = 0.1});
  expect_differences<Sklyanin>({0.7, 0.4, -0.5, 0.6}, {.method = "symplectic-groupoid", .step = 0.1});
  expect_differences<LotkaVolterra>({2, 0.5},
                                    {.method = "splitting", .step = 0.1, .composition = compositions::suzuki});
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
  for (const char* method : {"projected-midpoint", "extrapolation"})
    EXPECT_THROW(make_poisson_integrator(EulerTop(), {1, 0, 1}, {.method = method})->slope({}), std::invalid_argument);
}

}  // namespace
}  // namespace poisson_slopes_tests
}  // namespace lagroid
